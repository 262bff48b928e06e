"""Choices by constants keep one side, constants are converted to u32 before they are written; all else stays.

The first source made naga 29.0.3 panic, which ends the process: it is built on every target.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32
from codegen.ir.unit import Unit
from codegen.ir.verify import verify_selection
from codegen.library import load_library
from codegen.passes.printing.decided import drop_decided
from conformance.unit.support.sources import library_of
from targets import TimedRuntime

NESTED = """def probe(x: X) -> vec3:
    return vec3(vec2(1.0), 1.0) * x if abs(3.0) > 2.0 and True else vec3(vec2(2.0, x), 3.0)
"""
PANICS = "def probe(x: X) -> vec3:\n    return x * (vec3(vec2(1.0), 1.0) if abs(3.0) > 2.0 else vec3(3.0))\n"
SOURCES = {
    "true": ("x if 1.0 > 0.5 else 2.0", "x"),
    "false": ("x if not abs(-1.0) > 0.5 else 2.0", "2.0"),
    "within": ("(x if False else 3.0) if x > 1.0 else x", "3.0 if x > 1.0 else x"),
    "of a call": ("x if sin(x - x) > 0.5 else 2.0", "x if sin(x - x) > 0.5 else 2.0"),
}


@pytest.mark.parametrize("name", SOURCES)
def test_only_decided_ones_are_dropped(name: str, tmp_path: Path) -> None:
    bodies = []
    for k, text in enumerate(SOURCES[name]):
        library = library_of(tmp_path / str(k), f"def probe(x: X) -> f32:\n    return {text}\n")
        selection = library.select(["probe"])
        verify_selection(selection.functions)
        bodies.append(drop_decided(Unit(selection.functions, ())).functions[0].body)
        verify_selection(drop_decided(Unit(selection.functions, ())).functions)
    assert bodies[0] == bodies[1]


I, U, TEN, LESS = ir.Var(I32, "i"), ir.Var(U32, "u"), ir.Const(I32, 10), ir.Const(I32, -10)
TOP = ir.Const(U32, 2**31)
AT_LEAST = ir.Binary(I32, "-", ir.Const(I32, -(2**31) + 1), ir.Const(I32, 1))
"""The least integer, which has no literal in C."""
SETTLED: list[tuple[ir.Expr, ir.Expr]] = [
    (ir.Convert(U32, TEN), ir.Const(U32, 10)),
    (ir.Convert(U32, LESS), ir.Const(U32, 2**32 - 10)),
    (ir.Convert(U32, ir.Unary(I32, "negate", TEN)), ir.Const(U32, 2**32 - 10)),
    (ir.Convert(U32, ir.Binary(I32, "*", TEN, LESS)), ir.Const(U32, 2**32 - 100)),
    (ir.Convert(U32, I), ir.Convert(U32, I)),
    (ir.Convert(U32, ir.Const(F32, 2.0)), ir.Convert(U32, ir.Const(F32, 2.0))),
    (ir.Convert(F32, TEN), ir.Convert(F32, TEN)),
    (ir.Convert(I32, ir.Const(U32, 7)), ir.Convert(I32, ir.Const(U32, 7))),
    (ir.Select(U32, ir.Const(BOOL, True), U, ir.Const(U32, 1)), U),
    (
        ir.Binary(U32, "<<", ir.Select(U32, ir.Const(BOOL, False), U, TOP), ir.Const(U32, 31)),
        ir.Const(U32, 0),
    ),
    (ir.Binary(I32, "*", TEN, LESS), ir.Const(I32, -100)),
    (ir.Binary(I32, "*", TEN, I), ir.Binary(I32, "*", TEN, I)),
    (AT_LEAST, AT_LEAST),
    (ir.Select(U32, ir.Const(BOOL, False), ir.Const(U32, 1), U), U),
    (ir.Select(I32, ir.Binary(BOOL, "<", TEN, LESS), TEN, I), I),
    (ir.Select(I32, ir.Binary(BOOL, "<", LESS, TEN), I, TEN), I),
    (
        ir.Select(I32, ir.Binary(BOOL, "<", I, TEN), I, TEN),
        ir.Select(I32, ir.Binary(BOOL, "<", I, TEN), I, TEN),
    ),
]


@pytest.mark.parametrize(("given", "wanted"), SETTLED, ids=range(len(SETTLED)))
def test_constants_are_settled_and_nothing_else(given: ir.Expr, wanted: ir.Expr) -> None:
    parameters = ir.Parameter("i", I32, None), ir.Parameter("u", U32, None)
    place = load_library().function("sin_angle")
    whole = replace(place, parameters=parameters, returns=given.type, body=(ir.Return(given),))
    (made,) = drop_decided(Unit((whole,), ())).functions
    assert made.body == (ir.Return(wanted),)
    assert (made.parameters, made.returns) == (parameters, given.type)


def test_the_library_has_none() -> None:
    functions = load_library().select().functions
    assert drop_decided(Unit(functions, ())).functions == functions


@pytest.mark.parametrize("source", [NESTED, PANICS], ids=["sides that vary", "constant sides"])
def test_every_target_builds_what_remains(source: str, runtime: TimedRuntime, tmp_path: Path) -> None:
    library = library_of(tmp_path, source)
    inputs = {"x": np.array([1.0, -2.0, 0.5], np.float32)}
    assert np.array_equal(execute(library, "probe", inputs, runtime), evaluate(library, "probe", inputs))  # type: ignore[arg-type]


@pytest.mark.parametrize("number", [-1, -(2**31), 7])
def test_whole_numbers_are_converted_before_they_are_written(
    number: int, runtime: TimedRuntime, tmp_path: Path
) -> None:
    library = library_of(tmp_path, "def probe(x: X) -> f32:\n    return f32(u32(2.0) ^ u32(i32(x)))\n")
    x = ir.Convert(I32, ir.Var(F32, "x"))
    made = library.function("probe")
    body = ir.map_body(made.body, lambda e: ir.Const(I32, number) if e == x else e)
    library = library.with_functions([replace(made, body=body)])
    found = execute(library, "probe", {"x": np.zeros(1, np.float32)}, runtime)
    assert found == np.array([2 ^ number % 2**32], np.float32)
