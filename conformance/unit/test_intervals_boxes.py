"""Interval operations on boxes: nothing that a table permits lies outside, and the ends are attained.

Plan. Each operation on random boxes (points, narrow and wide ones, few lanes and many), under every table,
against a hull made here from the exact values at many places of the box and the promise of the row:
  sound   the last float permitted at any of these places lies inside
  tight   the ends are no further out than the promise at the worst of these places, with what rounding and a
          spacing that doubles at a power of two add
  anything  where the promise ends, no number is given, and a cause is
Rows that inherit from a formula are held to figures in test_intervals_figures.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from codegen.intervals import TABLES, arithmetic, elementary, load_table, logic, numbers, operations
from codegen.intervals.accuracy import Absolute, Exact, Rounded, Ulp, Unstated
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.tables import Table
from codegen.intervals.values import Range, Whole

SEED = 20_261
LANES = (40, 1200)
"""Few lanes and many, which may be computed in another way."""
PLACES = 7
"""Places of each operand's interval: its ends and between."""
MARGIN = 3.0
"""Floats by which an end may lie further out than the promise: rounding of the end, and of the value."""
SPREAD = 1.01
"""Margin on the number of ULP where it varies over the box, between the places that are looked at."""

Array = Any


@dataclass(frozen=True)
class Case:
    """An operation: exact values, from where to where its operands lie, and where its extremes may be."""

    exact: Callable[..., Array]
    ranges: tuple[tuple[float, float], ...]
    extremes: tuple[float, ...] = ()


TURN = math.pi / 2.0
CASES = {
    "+": Case(np.add, ((-4.0, 4.0), (-4.0, 4.0))),
    "-": Case(np.subtract, ((-4.0, 4.0), (-4.0, 4.0))),
    "*": Case(np.multiply, ((-4.0, 4.0), (-3.0, 3.0)), (0.0,)),
    "/": Case(np.divide, ((-4.0, 4.0), (0.5, 3.0))),
    "min": Case(np.minimum, ((-4.0, 4.0), (-4.0, 4.0))),
    "max": Case(np.maximum, ((-4.0, 4.0), (-4.0, 4.0))),
    "clamp": Case(lambda x, a, b: np.minimum(np.maximum(x, a), b), ((-4.0, 4.0), (-2.0, 0.0), (0.5, 3.0))),
    "negate": Case(np.negative, ((-4.0, 4.0),)),
    "abs": Case(np.abs, ((-4.0, 4.0),), (0.0,)),
    "floor": Case(np.floor, ((-4.0, 4.0),)),
    "inverse_sqrt": Case(lambda x: 1.0 / np.sqrt(x), ((0.1, 9.0),)),
    "sqrt": Case(np.sqrt, ((0.1, 9.0),)),
    "exp": Case(np.exp, ((-9.0, 9.0),)),
    "exp2": Case(np.exp2, ((-9.0, 9.0),)),
    "log": Case(np.log, ((0.1, 9.0),)),
    "log2": Case(np.log2, ((0.1, 9.0),)),
    "sin": Case(np.sin, ((-3.1, 3.1),), (-TURN, TURN)),
    "cos": Case(np.cos, ((-3.1, 3.1),), (0.0,)),
    "atan2": Case(np.arctan2, ((-4.0, 4.0), (0.25, 3.0))),
}


def spacing(x: Array) -> Array:
    """Muller's ULP of float32, the larger one at a power of two."""
    return np.spacing(np.abs(x).astype(np.float32)).astype(np.float64)


def boxes(rng: np.random.Generator, low: float, high: float, lanes: int) -> tuple[Array, Array]:
    """Ends of intervals inside another: a third of them points, a third a few floats wide."""
    a = rng.uniform(low, high, lanes).astype(np.float32)
    narrow = (a + 4.0 * np.spacing(a)).astype(np.float32)
    wide = rng.uniform(low, high, lanes).astype(np.float32)
    b = np.choose(np.arange(lanes) % 3, [a, np.minimum(narrow, np.float32(high)), wide])
    return np.minimum(a, b).astype(np.float64), np.maximum(a, b).astype(np.float64)


def places(low: Array, high: Array, extremes: tuple[float, ...]) -> Array:
    """Numbers of each interval, (places, lanes); extremes that it holds among them."""
    between = [low + (high - low) * k / (PLACES - 1) for k in range(PLACES)]
    return np.stack([*between, *(np.clip(e, low, high) for e in extremes)])


def grid(case: Case, operands: list[tuple[Array, Array]]) -> list[Array]:
    """Every combination of the places of all operands, (combinations, lanes) each."""
    columns = [places(low, high, case.extremes) for low, high in operands]
    index = np.indices([len(c) for c in columns]).reshape(len(columns), -1)
    return [c[k] for c, k in zip(columns, index, strict=True)]


def promised(table: Table, op: str, exact: Array, at: list[Array]) -> tuple[Array, Array]:
    """How far a result may be from the exact one by the row, at least and with all margins."""
    match table.row(op).accuracy:
        case Exact():
            return np.zeros_like(exact), np.zeros_like(exact)
        case Rounded():
            least = np.zeros_like(exact) if table.rounding == "nearest" else 0.999 * spacing(exact)
            return np.where(exact == exact.astype(np.float32), 0.0, least), spacing(exact)
        case Ulp(ulps, per_abs_x, whole, _):
            growth = per_abs_x * np.abs(at[0])
            count = ulps + (np.floor(growth) if whole else growth)
            # Where only whole ULP count, those at the larger end of the argument may be granted at both.
            most = (ulps + np.ceil(growth * SPREAD)).max(axis=0) if whole else count * SPREAD
            return count * spacing(exact), most * spacing(np.abs(exact) + 2.0 * count * spacing(exact))
        case Absolute(bound, (first, last), elsewhere):
            far = 0.0 if elsewhere is None else elsewhere.ulps
            near = (at[0] >= first) & (at[0] <= last)
            least = np.where(near, bound, far * spacing(exact))
            return least, np.maximum(bound, 2.0 * far * spacing(exact))
        case other:
            raise AssertionError(f"no hull of {other}")


def evaluated(table: Table, op: str, operands: list[tuple[Array, Array]]) -> Range:
    """What the interval operation gives."""
    context = Context(table, CauseBook(), len(operands[0][0]))
    ranges = tuple(Range(low, high) for low, high in operands)
    with np.errstate(all="ignore"):
        if op == "negate":
            found = operations.unary(context, op, ranges[0])
        elif op in "+-*/":
            found = operations.binary(context, op, ranges[0], ranges[1])
        else:
            found = operations.scalar_builtin(context, op, *ranges)
    assert isinstance(found, Range)
    return found


def judged_here(table: Table, op: str) -> bool:
    return isinstance(table.row(op).accuracy, Exact | Rounded | Ulp | Absolute)


OFF_ZERO = {("/", "opencl_relaxed"), ("atan2", "wgsl"), ("atan2", "glsl"), ("atan2", "glsl_es")}
"""Rows that promise nothing for a first operand near 0."""
CHECKED = [(op, name) for op in CASES for name in TABLES if judged_here(load_table(name), op)]


@pytest.mark.parametrize("lanes", LANES)
@pytest.mark.parametrize(("op", "name"), CHECKED)
def test_ends_are_where_the_promise_ends(op: str, name: str, lanes: int) -> None:
    rng = np.random.default_rng(SEED)
    case, table = CASES[op], load_table(name)
    operands = [boxes(rng, low, high, lanes) for low, high in case.ranges]
    if (op, name) in OFF_ZERO:
        kept = (operands[0][0] > 0.0) | (operands[0][1] < 0.0)
        operands = [(low[kept], high[kept]) for low, high in operands]
        lanes = len(operands[0][0])
    found = evaluated(table, op, operands)
    assert found.cause is None or not found.cause.any()
    low, high = (np.broadcast_to(end, lanes) for end in (found.low, found.high))
    at = grid(case, operands)
    exact = case.exact(*at)
    least, most = promised(table, op, exact, at)
    inside = np.nextafter((exact - least).astype(np.float32), np.float32(np.inf)).astype(np.float64)
    assert (low <= np.maximum(inside, exact - least)).all()
    inside = np.nextafter((exact + least).astype(np.float32), np.float32(-np.inf)).astype(np.float64)
    assert (high >= np.minimum(inside, exact + least)).all()
    slack = MARGIN * spacing(np.abs(exact) + most).max(axis=0)
    assert (low >= (exact - most).min(axis=0) - slack).all()
    assert (high <= (exact + most).max(axis=0) + slack).all()


@pytest.mark.parametrize(("op", "name"), CHECKED)
def test_points_are_points_where_nothing_is_rounded(op: str, name: str) -> None:
    """One and the same array for both ends says that a value is known; exact operations keep that."""
    rng = np.random.default_rng(SEED)
    case, table = CASES[op], load_table(name)
    values = [rng.uniform(low, high, 50).astype(np.float32).astype(np.float64) for low, high in case.ranges]
    found = evaluated(table, op, [(v, v) for v in values])
    wide = evaluated(table, op, [(v, v.copy()) for v in values])
    if table.row(op).accuracy == Exact():
        assert found.is_point
        assert np.array_equal(found.low, case.exact(*values))
    # The same interval, or one that allows for less: a known value crosses no power of two.
    assert (found.low >= wide.low).all()
    assert (found.high <= wide.high).all()
    if table.row(op).accuracy != Rounded() or table.rounding == "either":
        assert (found.low <= case.exact(*values)).all()
        assert (found.high >= case.exact(*values)).all()


ENDINGS: dict[str, tuple[tuple[tuple[float, float], ...], dict[str, bool]]] = {
    "/": (((1.0, 2.0), (-1.0, 1.0)), dict.fromkeys(TABLES, False)),
    "inverse_sqrt": (((0.0, 1.0),), dict.fromkeys(TABLES, False)),
    "sqrt": (((-1.0, 1.0),), dict.fromkeys(TABLES, False)),
    "log": (((-1.0, 1.0),), dict.fromkeys(TABLES, False)),
    "log2": (((0.0, 0.0),), dict.fromkeys(TABLES, False)),
    "exp": (((80.0, 90.0),), dict.fromkeys(TABLES, False)),
    "sin": (((3.0, 4.0),), dict.fromkeys(TABLES, False) | {"opencl": True}),
    "cos": (((-4.0, -3.0),), dict.fromkeys(TABLES, False) | {"opencl": True}),
    "atan2": (((-1.0, 1.0), (-1.0, 1.0)), dict.fromkeys(TABLES, False)),
}
"""Boxes that reach beyond a promise, and under which tables they are bounded all the same."""


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("op", ENDINGS)
def test_nothing_is_said_beyond_a_promise(op: str, name: str) -> None:
    bounds, bounded = ENDINGS[op]
    inside = [low for low, _ in CASES[op].ranges] if op != "cos" else [0.5]
    operands = [
        (np.array([a, max(i, 0.5)], np.float64), np.array([b, max(i, 0.5)], np.float64))
        for (a, b), i in zip(bounds, inside, strict=True)
    ]
    found = evaluated(load_table(name), op, operands)
    causes = np.zeros(2, np.int16) if found.cause is None else np.broadcast_to(found.cause, 2)
    assert (causes == 0).tolist() == [bounded[name], True]
    assert np.isinf(found.low[0]) == np.isinf(found.high[0]) == (not bounded[name])
    assert np.isfinite(found.low[1]) and np.isfinite(found.high[1])


@pytest.mark.parametrize("op", ["exp", "exp2", "log", "log2", "sin", "cos", "atan2"])
def test_nothing_is_said_where_a_specification_says_nothing(op: str) -> None:
    table = load_table("wgsl")
    silent = replace(table, rows={**table.rows, op: replace(table.row(op), accuracy=Unstated())})
    one = np.full(3, 0.75)
    found = evaluated(silent, op, [(one, one)] * len(CASES[op].ranges))
    assert found.cause is not None and (found.cause > 0).all()
    assert np.isinf(found.low).all() and np.isinf(found.high).all()


def test_a_double_just_beside_a_float_may_be_that_float() -> None:
    """What float64 gave is granted an error of 8 of its ULP; more is no promise of ours."""
    value = np.array([1.0, 1.5, 3.0, 100.0, 0.1875])
    for sign in (1.0, -1.0):
        x = sign * value
        for beside in (1.0 - 2.0**-52, 1.0 + 2.0**-51):
            near = x * beside
            low, high = arithmetic.within_ulp(near, near, 0.0, 0.0)
            assert ((low <= x) & (x <= high)).all()
            low, high = arithmetic.within_ulp(near, near.copy(), 0.0, 0.0)
            assert ((low <= x) & (x <= high)).all()
        for further in (1.0 - 2.0**-45, 1.0 + 2.0**-45):
            far = x * further
            low, high = arithmetic.within_ulp(far, far, 0.0, 0.0)
            assert ((low > x) | (x > high)).all()


def bits_of(x: float) -> int:
    return int(np.float32(x).view(np.uint32))


@pytest.mark.parametrize(
    ("first", "last", "low", "high"),
    [
        (1.0, 2.5, 1.0, 2.5),
        (-1.0, -2.5, -2.5, -1.0),
        (-0.5, -0.5, -0.5, -0.5),
        (3.0, -1.0, -np.inf, np.inf),
        (1.0, np.inf, -np.inf, np.inf),
    ],
)
def test_bits_between_two_floats(first: float, last: float, low: float, high: float) -> None:
    """Of one sign, they are floats between; of two, infinities and NaN are among them."""
    context = Context(load_table("wgsl"), CauseBook(), 1)
    ends = np.array([bits_of(first)], np.int64), np.array([bits_of(last)], np.int64)
    found = logic.from_bits(context, Whole(*ends, False))
    assert (found.low[0], found.high[0]) == (low, high)
    assert (found.cause is not None and bool(found.cause.any())) == bool(np.isinf(low))


@pytest.mark.parametrize("large", [(1.0, 2.0**28, 1.0), (-(2.0**28), 1.0, 1.0)])
@pytest.mark.parametrize("turned", [False, True])
def test_far_ends_make_sums_inexact(large: numbers.Reach, turned: bool) -> None:
    """Whichever operand it is, and on whichever side."""
    small = (1.0, 2.0, 1.0)
    assert not numbers.exact_sums(*((large, small) if turned else (small, large)))
    assert numbers.exact_sums(small, small)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("turns", [0, 1, 1000, 10**6])
def test_an_extreme_that_float64_cannot_place_may_be_held(turns: int, sign: float) -> None:
    """An interval that ends two float64 short of an extreme may hold it; one that ends well short, not."""
    extreme = math.pi / 2.0 + sign * turns * 2.0 * math.pi
    step = 2.0 * np.spacing(abs(extreme))
    inside, far = extreme - 0.5, extreme + 0.5
    ends = [(inside, extreme - step), (extreme + step, far), (inside, far), (inside, extreme - 1e-3)]
    low, high = (np.array(side) for side in zip(*ends, strict=True))
    assert elementary._holds(Range(low, high), math.pi / 2.0).tolist() == [True, True, True, False]


def test_the_first_operand_that_breaks_a_promise_is_named() -> None:
    """atan2 checks x before y, and names no operand where the promise holds."""
    table, context = load_table("wgsl"), Context(load_table("wgsl"), CauseBook(), 3)
    assert table.row("atan2").normal
    y, x = np.array([1e-40, 1e-40, 1.0]), np.array([2.0**127, 1.0, 2.0**127])
    found = elementary.arc_tangent(context, Range(y, y), Range(x, x))
    assert found.cause is not None
    assert [context.book.causes[code - 1].operand for code in found.cause] == ["x", "y", "x"]
