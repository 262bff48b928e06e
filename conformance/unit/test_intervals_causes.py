"""Why a result may be anything: which operand of which operation, and for what reason; what follows of it.

Plan. Hand-made values, and functions of one line.
  told      operand and reason of what may give anything; the first operand's cause comes first
  infinite  what may be anything has infinite ends, also through normalised vectors; it decides no comparison
            and is no fork
  choices   bring the cause of the side that may be chosen
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.intervals import (
    TABLES,
    arithmetic,
    compiled,
    elementary,
    load_table,
    logic,
    operations,
    permitted,
)
from codegen.intervals.causes import Cause, CauseBook
from codegen.intervals.context import Context
from codegen.intervals.values import Range, Truth, Whole, choose
from conformance.unit.support.sources import library_of

INF = np.inf


def ends(*pairs: tuple[float, float]) -> tuple[Any, Any]:
    low, high = zip(*pairs, strict=True)
    return np.array(low, np.float64), np.array(high, np.float64)


@pytest.mark.parametrize("name", TABLES)
def test_no_angle_has_both_sides_zero(name: str) -> None:
    context = Context(load_table(name), CauseBook(), 2)
    one_or_zero = np.array([1.0, 0.0])
    found = elementary.arc_tangent(context, Range(one_or_zero, one_or_zero), Range(one_or_zero, one_or_zero))
    assert found.cause is not None and found.cause[1] > 0
    (told,) = {context.book.causes[code - 1] for code in found.cause[1:]}
    assert (told.operand, told.reason) == ("y, x", "both may be 0")


@pytest.mark.parametrize("name", [n for n in TABLES if load_table(n).row("atan2").magnitude])
def test_angle_of_what_is_outside_the_promise_tells_its_operand(name: str) -> None:
    row = load_table(name).row("atan2")
    values = {"x": np.array([1.0, 1.0]), "y": np.array([1.0, 1.0])}
    for operand, (_, last) in row.magnitude.items():
        beyond = {**values, operand: np.array([1.0, 2.0 ** (last + 1)])}
        context = Context(load_table(name), CauseBook(), 2)
        y, x = (Range(beyond[n], beyond[n].copy()) for n in ("y", "x"))
        found = elementary.arc_tangent(context, y, x)
        assert found.cause is not None
        assert (found.cause > 0).tolist() == [False, True]
        assert [cause.operand for cause in context.book.causes] == [operand]
    smallest = np.array([float(np.finfo(np.float32).tiny)])  # is a normal number
    one = np.array([1.0])
    found = elementary.arc_tangent(
        Context(load_table(name), CauseBook(), 1), Range(smallest, smallest), Range(one, one)
    )
    assert found.cause is None


@pytest.mark.parametrize("op", ["<", "<=", ">", ">="])
def test_input_that_is_not_finite_decides_no_comparison(op: str) -> None:
    """Neither in numpy nor in a compiled loop, which sees its ends only."""
    for loops in (False, True):
        context = Context(load_table("wgsl"), CauseBook(), 2)
        context.loops = loops
        x = arithmetic.from_input(context, np.array([INF, -INF], np.float32))
        one = Range(*ends((1.0, 1.0), (1.0, 1.0)))
        for found in (logic.compare(context, op, x, one), logic.compare(context, op, one, x)):
            assert found.true.all() and found.false.all()


@pytest.mark.parametrize("table", TABLES)
def test_what_may_be_anything_has_infinite_ends(table: str, tmp_path: Path) -> None:
    text = "def probe(x: X) -> f32:\n    return normalize(vec3(1.0 / x, 1.0, 1.0)).x\n"
    found: Any = permitted(
        library_of(tmp_path, text), "probe", {"x": np.array([0.0, 2.0], np.float32)}, table
    )
    assert found.guaranteed.tolist() == [False, True]
    assert np.isinf(found.low).tolist() == np.isinf(found.high).tolist() == [True, False]


CAUSES = {
    "bits_to_float(u32(x))": (0.0, 2139095040.0, "x", "the bits may be no finite number"),
    "f32(u32(x))": (1.0, -3.0, "x", "outside the integers of the type"),
    "f32(i32(x))": (1.0, 3e9, "x", "outside the integers of the type"),
    "1.0 / x": (1.0, 0.0, "y", "the divisor may be 0"),
    "x * x": (1.0, 3e30, "", "the result may overflow"),
    "atan2(x, x)": (1.0, 0.0, "y, x", "both may be 0"),
}
"""An expression, a number that it takes, and one of which it may give anything, with operand and reason."""


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("text", CAUSES)
def test_what_may_be_anything_says_why(text: str, table: str, tmp_path: Path) -> None:
    good, bad, operand, reason = CAUSES[text]
    library = library_of(tmp_path, f"def probe(x: X) -> f32:\n    return {text}\n")
    found: Any = permitted(library, "probe", {"x": np.array([good, bad], np.float32)}, table)
    assert found.guaranteed.tolist() == [True, False]
    ((told, count),) = found.histogram().items()
    assert (told.function, told.operand, told.reason, count) == ("probe", operand, reason, 1)


def test_cause_is_a_sentence() -> None:
    assert str(Cause("f", 3, "/", "y", "the divisor may be 0")) == "line 3 of f: / of y: the divisor may be 0"
    assert str(Cause("f", 4, "*", "", "the result may overflow")) == "line 4 of f: *: the result may overflow"


@pytest.mark.parametrize("op", ["min", "max", "clamp"])
def test_cause_of_the_first_operand_is_told(op: str) -> None:
    number, word = np.array([1.0]), np.array([1])
    codes = [np.array([code], np.int16) for code in (5, 7, 9)][: 3 if op == "clamp" else 2]
    context = Context(load_table("wgsl"), CauseBook(), 1)
    for operands in ([Range(number, number, c) for c in codes], [Whole(word, word, False, c) for c in codes]):
        found = operations.scalar_builtin(context, op, *operands)
        assert isinstance(found, Range | Whole) and found.cause is not None
        assert found.cause.tolist() == [5]


def test_chosen_side_brings_its_cause() -> None:
    """The first side's where it may be chosen, the second's where only that may; none of the other's."""
    condition = Truth(np.array([True, False, True]), np.array([False, True, True]))
    zero = np.zeros(3)
    first, second = (Range(zero, zero + 1.0, np.full(3, code, np.int16)) for code in (5, 7))
    bounded = Range(zero, zero + 1.0)
    for a, b, codes in (
        (first, second, [5, 7, 5]),
        (first, bounded, [5, 0, 5]),
        (bounded, second, [0, 7, 7]),
    ):
        found = choose(condition, a, b)
        assert isinstance(found, Range) and found.cause is not None
        assert found.cause.tolist() == codes


@pytest.mark.parametrize(
    ("table", "text", "told"),
    [
        ("wgsl", "dot(vec2(1.0 / x, sqrt(y)), vec2(1.0, 1.0))", "the divisor may be 0"),
        ("wgsl", "dot(vec2(sqrt(y), 1.0 / x), vec2(1.0, 1.0))", "x may be negative"),
        ("vulkan", "normalize(vec2(1.0 / x, sqrt(y))).x", "the divisor may be 0"),
        ("vulkan", "normalize(vec2(1.0 / x, sqrt(y))).y", "x may be negative"),
    ],
)
def test_cause_of_the_first_term_and_of_the_component_is_told(
    table: str, text: str, told: str, tmp_path: Path
) -> None:
    library = library_of(tmp_path, f"def probe(x: X, y: X) -> f32:\n    return {text}\n")
    inputs = {"x": np.array([0.0], np.float32), "y": np.array([-1.0], np.float32)}
    assert permitted(library, "probe", inputs, table).cause(0).endswith(told)


def test_share_of_a_length_may_be_anything_where_the_quotient_may(tmp_path: Path) -> None:
    """A component too small for the quotients of a table, beside one that is not."""
    text = "def probe(x: X) -> f32:\n    return normalize(vec2(x, 1.0)).x\n"
    table = load_table("wgsl")
    quotient = replace(table.row("/"), magnitude={"x": (-62, 62)})
    of_few = replace(table, rows={**table.rows, "/": quotient})
    x = np.array([2.0**-70, 0.5], np.float32)
    found: Any = permitted(library_of(tmp_path, text), "probe", {"x": x}, of_few)
    assert found.guaranteed.tolist() == [False, True]
    assert (found.low[0], found.high[0]) == (-INF, INF)


@pytest.mark.parametrize("nan_first", [True, False])
def test_what_may_be_anything_is_no_fork(nan_first: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also beside what a compiled choice leaves of NaN, which may be the other side alone."""
    monkeypatch.setattr(compiled, "FEWEST", 2)
    here = Context(load_table("wgsl"), CauseBook(), 2)
    nan = arithmetic.from_input(here, np.array([np.nan, 1.0], np.float32))
    some = Range(*ends((2.25, 5.5), (2.25, 5.5)))
    both = Truth(np.ones(2, np.bool_), np.ones(2, np.bool_))
    chosen = choose(both, nan, some) if nan_first else choose(both, some, nan)
    assert isinstance(chosen, Range)
    found = logic.floor(here, chosen)
    assert found.cause is not None and (found.cause > 0).tolist() == [True, False]
    assert here.first_fork.tolist() == [-1, 0]
