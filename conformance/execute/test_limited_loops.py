"""Loops that a parameter ends early: range(min(PARAMETER, CONSTANT)).

Plan. One function that counts and sums, over limits of 0, 1, a few, the constant and far beyond:
  meaning      the numbers are those of Python's own range, in every arithmetic and on every target
  intervals    hold them; where the limit is known they are as narrow as those of a constant loop
  text         the limit stands in the head of the loop, in its own type
  specialised  a known limit becomes the bound, an unknown one stays; a loop that may return needs a known one
  verify       limits of another type, or that the loop changes, are malformed
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from codegen.backends import dialect
from codegen.emit.module import emit
from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32
from codegen.ir.verify import MalformedIRError, verify
from codegen.library import Library
from codegen.passes.specialise import specialise
from conformance.unit.support.sources import library_of
from conformance.unit.support.trees import no_function
from targets import TimedRuntime

MOST = 12
SOURCE = f"""
def total(n: Annotated[u32, Interval(0, 100)], m: Annotated[i32, Interval(-5, 100)]) -> f32:
    \"\"\"Sums of whole numbers.\"\"\"
    sum = 0.0
    for i in range(min(n, {MOST})):
        sum += f32(i)
    for k in range(min(m, {MOST})):
        if k < 3:
            sum += 100.0
    return sum
"""
N = [0, 1, 2, 7, MOST, MOST + 1, 2**32 - 1, 5]
M = [0, -5, 1, 2, 3, 4, 100, -(2**31)]
WANTED = [sum(range(min(n, MOST))) + 100.0 * min(max(m, 0), 3) for n, m in zip(N, M, strict=True)]
INPUTS = {"n": np.array(N, np.uint32), "m": np.array(M, np.int32)}


@pytest.fixture
def library(tmp_path: Path) -> Library:
    return library_of(tmp_path, SOURCE)


@pytest.mark.parametrize("arithmetic", ["float32", "float64", "mpmath"])
def test_meaning(library: Library, arithmetic: str) -> None:
    assert np.asarray(evaluate(library, "total", INPUTS, arithmetic)).astype(float).tolist() == WANTED


def test_on_devices(library: Library, runtime: TimedRuntime) -> None:
    assert np.asarray(execute(library, "total", INPUTS, runtime)).tolist() == WANTED


@pytest.mark.parametrize("table", sorted(set(DEFAULT_TABLES.values())))
def test_intervals(library: Library, table: str) -> None:
    found = permitted(library, "total", INPUTS, table)
    assert found.contains(np.array(WANTED, np.float32)).all()
    assert not found.contains(np.array(WANTED, np.float32) + 1.0).any()


def test_text(library: Library) -> None:
    heads = {
        "glsl": "for (uint i = 0u; i < min(n, 12u); i++) {",
        "wgsl": "for (var i = 0u; i < min(n, 12u); i++) {",
        "opencl": "for (uint i = 0u; i < min(n, 12u); i++) {",
    }
    for target, head in heads.items():
        assert head in emit(library, dialect(target), ["total"])


@pytest.mark.parametrize(("n", "unroll"), [(None, 32), (5, 0), (5, 32), (20, 0)])
def test_specialised(library: Library, n: int | None, unroll: int) -> None:
    constants = {} if n is None else {"n": n}
    found = specialise(library, "total", constants, new_name="part", unroll=unroll).function
    verify(found, no_function)
    loops = [s for s in ir.statements(found.body) if isinstance(s, ir.For)]
    known = [s.stop for s in loops if isinstance(s.limit, ir.Const)]
    assert known == ([] if n is None or unroll else [min(n, MOST)])
    assert len(loops) - len(known) == (2 if n is None else 1)
    text = emit(library.with_functions([found]), dialect("glsl"), ["part"])
    assert all(f"i < {stop}u;" in text for stop in known)
    limits = np.full(len(M), n, np.uint32) if n is not None else INPUTS["n"]
    general = evaluate(library, "total", {"n": limits, "m": INPUTS["m"]})
    inputs = {name: value for name, value in INPUTS.items() if name != "n" or n is None}
    np.testing.assert_array_equal(evaluate(library.with_functions([found]), "part", inputs), general)


def test_a_limited_loop_that_returns_is_specialised(tmp_path: Path, runtime: TimedRuntime) -> None:
    """And computes the same, here and on devices; some lanes return from the loop, others behind it."""
    source = SOURCE.replace("if k < 3:", "if k > 2:").replace("sum += 100.0", "return sum + f32(k)")
    library = library_of(tmp_path, source)
    found = specialise(library, "total", new_name="part").function
    verify(found, no_function)
    extended = library.with_functions([found])
    wanted = evaluate(library, "total", INPUTS)
    assert {66.0, 69.0} <= set(np.asarray(wanted).tolist())
    np.testing.assert_array_equal(evaluate(extended, "part", INPUTS), wanted)
    np.testing.assert_array_equal(execute(extended, "part", INPUTS, runtime), wanted)


LIMIT = ir.Var(I32, "y")
BAD = {
    "a float": ir.For("i", 0, 3, (), limit=ir.Const(F32, 1.0)),
    "not from 0": ir.For("i", 1, 3, (), limit=LIMIT),
    "changed": ir.For("i", 0, 3, (ir.Assign("y", ir.Const(I32, 1)),), limit=LIMIT),
}


@pytest.mark.parametrize("case", BAD)
def test_malformed(library: Library, case: str) -> None:
    body = (ir.Let("y", ir.Const(I32, 2), True), BAD[case], ir.Return(ir.Const(F32, 0.0)))
    with pytest.raises(MalformedIRError, match='the loop over "i"'):
        verify(replace(library.function("total"), body=body), no_function)
