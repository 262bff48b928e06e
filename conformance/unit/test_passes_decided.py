"""Conditional expressions with a constant condition keep one side; all others stay as they are.

The first source made naga 29.0.3 panic, which ends the process: it is built on every target.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.execute import execute
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


def test_the_library_has_none() -> None:
    functions = load_library().select().functions
    assert drop_decided(Unit(functions, ())).functions == functions


@pytest.mark.parametrize("source", [NESTED, PANICS], ids=["sides that vary", "constant sides"])
def test_every_target_builds_what_remains(source: str, runtime: TimedRuntime, tmp_path: Path) -> None:
    library = library_of(tmp_path, source)
    inputs = {"x": np.array([1.0, -2.0, 0.5], np.float32)}
    assert np.array_equal(execute(library, "probe", inputs, runtime), evaluate(library, "probe", inputs))  # type: ignore[arg-type]
