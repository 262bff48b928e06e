"""Roots, exponentials, logarithms and trigonometry at the places where their promises change.

Plan. Values by hand, each with the row that is meant, not with a table's.
  roots       0 has the root 0; what may be negative is anything, from the first number below 0 on
  ULP         numbers that grow with the argument, whole ones at its larger end
  logarithms  the absolute bound within its interval, ULP outside, the wider where either may be
  waves       extremes within, at and beyond the ends of an interval; places that float64 cannot tell
  angles      all four quarters, the cut, and rows without limits
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from codegen.intervals import arithmetic, elementary, load_table
from codegen.intervals.accuracy import Absolute, Accuracy, Row, Ulp, Unstated
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.values import Range
from conformance.unit.support.tolerances import tolerance

INF = math.inf


def context(lanes: int, operation: str = "", accuracy: Accuracy | None = None, **limits: Any) -> Context:
    table = load_table("wgsl")
    if accuracy is not None:
        table = replace(table, rows={**table.rows, operation: Row(accuracy, "c", **limits)})
    return Context(table, CauseBook(), lanes)


def boxes(*ends: tuple[float, float], cause: Any = None) -> Range:
    return Range(np.array([e[0] for e in ends]), np.array([e[1] for e in ends]), cause)


def causes(found: Range, here: Context) -> list[str]:
    codes = [0] * len(found.low) if found.cause is None else found.cause.tolist()
    told = here.book.causes
    return [f"{told[c - 1].operand}: {told[c - 1].reason}" if c else "" for c in codes]


def within(exact: list[tuple[float, float]], ulps: float) -> list[tuple[float, float]]:
    least, most = np.array([e[0] for e in exact]), np.array([e[1] for e in exact])
    low, high = arithmetic.within_ulp(least, most, ulps, ulps)
    return list(zip(low.tolist(), high.tolist(), strict=True))


def pairs(found: Range) -> list[tuple[float, float]]:
    return list(zip(found.low.tolist(), found.high.tolist(), strict=True))


@pytest.mark.parametrize("accuracy", [None, Ulp(3.0)])
def test_roots_at_and_below_0(accuracy: Accuracy | None) -> None:
    here = context(5, "sqrt", accuracy)
    with np.errstate(all="ignore"):
        found = elementary.square_root(
            here, boxes((0.0, 0.0), (0.0, 4.0), (-0.5, 4.0), (4.0, 9.0), (-2.0, -1.0))
        )
    assert causes(found, here) == ["", "", "x: x may be negative", "", "x: x may be negative"]
    assert pairs(found)[0] == (0.0, 0.0) and found.low[1] == 0.0 and 2.0 <= found.high[1] < 2.000003
    assert 1.999997 < found.low[3] <= 2.0 and 3.0 <= found.high[3] < 3.000005
    here = context(4)
    with np.errstate(all="ignore"):
        found = elementary.inverse_square_root(
            here, boxes((0.0, 1.0), (-1.0, 1.0), (4.0, 16.0), (1e-37, 1e-37))
        )
    assert causes(found, here) == ["x: x may be 0 or less"] * 2 + ["", ""]
    assert pairs(found)[2] == within([(0.25, 0.5)], 2.0)[0]


def test_causes_that_are_there_already_stay() -> None:
    codes = np.array([7, 0], np.int16)
    x = boxes((-1.0, 1.0), (1.0, 4.0), cause=codes)
    for made in (
        elementary.square_root,
        elementary.inverse_square_root,
        lambda here, x: elementary.logarithm(here, "log", x),
        lambda here, x: elementary.sine(here, "sin", Range(x.low, x.high * 0.5, x.cause)),
        lambda here, x: elementary.exponential(here, "exp", x),
    ):
        here = context(2)
        with np.errstate(all="ignore"):
            found = made(here, x)
        assert found.cause is not None and found.cause.tolist() == [7, 0] and here.book.causes == []


def test_numbers_of_ulp() -> None:
    x = boxes((-3.7, 1.2), (0.4, 2.3), (-2.6, -2.5))
    plain, growing, whole = Ulp(3.0), Ulp(3.0, 2.0), Ulp(3.0, 2.0, True)
    assert elementary._ulps(plain, x) == (3.0, 3.0)
    low, high = elementary._ulps(growing, x)
    assert np.allclose(np.asarray(low), [10.4, 3.8, 8.2]) and np.allclose(np.asarray(high), [5.4, 7.6, 8.0])
    for end in elementary._ulps(whole, x):
        assert np.asarray(end).tolist() == [10.0, 7.0, 8.0]


@pytest.mark.parametrize("name", ["exp", "exp2"])
def test_exponentials(name: str) -> None:
    base = math.e if name == "exp" else 2.0
    ends = [(-1.5, 2.25), (0.0, 0.0), (-20.0, -3.0), (5.0, 5.5)]
    here = context(len(ends), name, Ulp(4.0))
    with np.errstate(over="ignore"):
        found = elementary.exponential(here, name, boxes(*ends))
        assert pairs(found) == within([(base**a, base**b) for a, b in ends], 4.0)
        far = elementary.exponential(here, name, boxes((100.0, 129.0), (1.0, 1.0), (1.0, 1.0), (-1.0, 200.0)))
    assert causes(far, here) == [": the result may overflow", "", "", ": the result may overflow"]


@pytest.mark.parametrize("bound", [0.01, 1e-8])
@pytest.mark.parametrize("name", ["log", "log2"])
def test_logarithms(name: str, bound: float) -> None:
    function = math.log if name == "log" else math.log2
    ends = [
        (0.5, 2.0),
        (0.75, 1.5),
        (0.25, 0.4),
        (3.0, 9.0),
        (0.25, 0.75),
        (1.5, 3.0),
        (0.25, 4.0),
        (2.0, 2.0),
    ]
    bound, ulps = 0.01, 5.0
    here = context(len(ends), name, Absolute(bound, (0.5, 2.0), Ulp(ulps)))
    found = elementary.logarithm(here, name, boxes(*ends))
    for k, (a, b) in enumerate(ends):
        low, high = function(a), function(b)
        far = within([(low, high)], ulps)[0]
        near = low - bound, high + bound
        inside = a >= 0.5 and b <= 2.0
        touches = b >= 0.5 and a <= 2.0
        least = near[0] if inside else min(near[0], far[0]) if touches else far[0]
        most = near[1] if inside else max(near[1], far[1]) if touches else far[1]
        assert (found.low[k], found.high[k]) == pytest.approx((least, most), abs=tolerance("ends_of_curves"))
        if not touches:
            assert (found.low[k], found.high[k]) == far
    alone = elementary.logarithm(context(8, name, Absolute(bound, (0.5, 2.0))), name, boxes(*ends))
    assert alone.low[3] == pytest.approx(function(3.0) - bound, abs=tolerance("ends_beside_a_promise"))
    assert alone.high[2] == pytest.approx(function(0.4) + bound, abs=tolerance("ends_beside_a_promise"))
    few = elementary.logarithm(context(1, name, Ulp(ulps)), name, boxes((2.0, 3.0)))
    assert pairs(few) == within([(function(2.0), function(3.0))], ulps)
    here = context(3)
    bad = elementary.logarithm(here, name, boxes((0.0, 1.0), (-1.0, -0.5), (1e-37, 1.0)))
    assert causes(bad, here) == ["x: x may be 0 or less"] * 2 + [""]


HALF = math.pi / 2.0


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_waves(name: str) -> None:
    """Hulls over many places, with the extremes wherever they are."""
    rng = np.random.default_rng(7)
    low = rng.uniform(-40.0, 40.0, 200)
    high = low + rng.choice([0.0, 0.3, 2.0, 4.0, 7.0], 200)
    shift = 0.0 if name == "sin" else HALF
    found = elementary.sine(context(200, name, Ulp(4.0)), name, Range(low, high))
    for k in range(200):
        at = np.linspace(low[k], high[k], 3000)
        first, last = (
            math.ceil((low[k] + shift) / math.pi - 0.5),
            math.floor((high[k] + shift) / math.pi - 0.5),
        )
        extremes = [(n + 0.5) * math.pi - shift for n in range(first, last + 1)]
        values = np.sin(np.concatenate([at, extremes]) + shift)
        least, most = within([(values.min(), values.max())], 4.0)[0]
        assert (found.low[k], found.high[k]) == pytest.approx((least, most), abs=tolerance("ends_of_curves"))
    known = np.array([0.1, 2.0])
    function = math.sin if name == "sin" else math.cos
    found = elementary.sine(context(2, name, Ulp(4.0)), name, Range(known, known))
    assert pairs(found) == pytest.approx(
        np.array(within([(function(x),) * 2 for x in known], 4.0)), abs=tolerance("ends_of_curves")
    )


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_waves_within_an_interval_only(name: str) -> None:
    here = context(5, name, Absolute(0.25, (-3.0, 2.0)))
    x = boxes((-3.0, -2.9), (1.9, 2.0), (1.9, 2.01), (-3.01, -3.0), (0.1, 0.2))
    found = elementary.sine(here, name, x)
    bad = "x: x may lie outside the promised interval"
    assert causes(found, here) == ["", "", bad, bad, ""]
    function = math.sin if name == "sin" else math.cos
    ends = sorted((function(0.1), function(0.2)))
    assert pairs(found)[4] == pytest.approx(
        (ends[0] - 0.25, ends[1] + 0.25), abs=tolerance("ends_beside_a_promise")
    )


def test_places_that_float64_cannot_tell() -> None:
    near, far = 0.9e9, 1.1e9
    quiet = 2.0 * math.pi * math.floor(near / (2.0 * math.pi)) + 0.2
    x = boxes((quiet, quiet + 0.1), (far, far), (-far, -far), (-quiet, -quiet), (-far, 0.0), (0.0, far))
    assert elementary._holds(x, HALF).tolist() == [False, True, True, False, True, True]


QUARTERS = [
    ((1.0, 2.0), (1.0, 3.0)), ((1.0, 2.0), (-3.0, -1.0)), ((-2.0, -1.0), (1.0, 3.0)),
    ((-2.0, -1.0), (-3.0, -1.0)),
    ((1.0, 2.0), (-1.0, 1.0)), ((-2.0, -1.0), (-1.0, 1.0)), ((-1.0, 2.0), (1.0, 3.0)),
    ((0.0, 1.0), (0.5, 1.0)),
]  # fmt: skip


def test_angles() -> None:
    y, x = (boxes(*(quarter[k] for quarter in QUARTERS)) for k in (0, 1))
    found = elementary.arc_tangent(context(len(QUARTERS), "atan2", Ulp(6.0)), y, x)
    for k, (b, a) in enumerate(QUARTERS):
        corners = [math.atan2(p, q) for p in b for q in a]
        assert (found.low[k], found.high[k]) == within([(min(corners), max(corners))], 6.0)[0]
    y, x = boxes((-1.0, 1.0), (0.0, 1.0), (-1.0, 0.0), (0.0, 0.0)), boxes(*[(-2.0, -1.0)] * 4)
    found = elementary.arc_tangent(context(4, "atan2", Ulp(6.0)), y, x)
    assert pairs(found) == within([(-math.pi, math.pi)] * 4, 6.0)
    here = context(4, "atan2", Ulp(6.0))
    y, x = (
        boxes((-1.0, 1.0), (0.0, 1.0), (0.5, 1.0), (0.0, 0.0)),
        boxes((-1.0, 1.0), (0.0, 1.0), (0.0, 1.0), (1.0, 1.0)),
    )
    found = elementary.arc_tangent(here, y, x)
    assert causes(found, here) == ["y, x: both may be 0"] * 2 + ["", ""]


def test_half_planes_that_end_at_the_origin() -> None:
    here = context(2, "atan2", Ulp(6.0))
    found = elementary.arc_tangent(here, boxes((-1.0, 1.0), (-1.0, 0.0)), boxes((-1.0, 0.0), (0.0, 1.0)))
    assert causes(found, here) == ["y, x: both may be 0"] * 2


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_bounds_are_granted_what_float64_may_lose(sign: float) -> None:
    for share in (0.9, -0.9):
        x = np.array([sign * 1.5 * (1.0 + share * 2.0**-49)])
        low, high = elementary._within_absolute(0.0, x, x)
        assert low[0] <= sign * 1.5 <= high[0]


def test_angles_with_limits_name_the_operand() -> None:
    out = "outside the promised magnitudes"
    here = context(4, "atan2", Ulp(6.0), magnitude={"x": (-1, 3)}, normal=("y",))
    y = boxes((1.0, 1.0), (1.0, 1.0), (1e-40, 1.0), (0.0, 0.0))
    x = boxes((0.5, 8.0), (0.4, 1.0), (1.0, 1.0), (0.0, 1.0))
    found = elementary.arc_tangent(here, y, x)
    assert causes(found, here) == ["", f"x: {out}", f"y: {out}", "y, x: both may be 0"]


@pytest.mark.parametrize("op", ["exp", "log2", "cos", "atan2"])
def test_what_nothing_is_said_of(op: str) -> None:
    here = context(2, op, Unstated())
    x = boxes((1.0, 2.0), (1.0, 2.0), cause=np.array([0, 9], np.int16))
    made = {
        "exp": lambda: elementary.exponential(here, op, x),
        "log2": lambda: elementary.logarithm(here, op, x),
        "cos": lambda: elementary.sine(here, op, x),
        "atan2": lambda: elementary.arc_tangent(here, x, Range(x.low, x.high)),
    }
    found = made[op]()
    assert found.cause is not None and found.cause.tolist() == [1, 9]
    assert here.book.causes[0].reason == "the specification promises nothing"
    assert here.book.causes[0].operand == "" and pairs(found) == [(-INF, INF)] * 2
