"""Corners of interval evaluation that random boxes seldom meet.

Plan. Hand-made values, and functions of one line.
  crossed ends   of a clamp: targets differ, so that both ways count
  cut            of atan2: on the negative x-axis either sign of pi
  zero           a dividend that is 0 although the promise begins above 0
  known lanes    of an integer that is an interval elsewhere stay exact; rounded to one integer, all are known
  words          keep their number where both types have it; over 0 they are what WGSL says
  denormals      ends on the grid of float32 where a table flushes nothing
  bits of zero   either word, and every word where something else than a number may be
  anything       has infinite ends, also as absolute value; why it is: test_intervals_causes.py
  choices        `and` and `or` are told apart
  many ways      a lane with more ways than are followed keeps the hull; so many forks are followed, no more
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.intervals import (
    DEFAULT_TABLES,
    TABLES,
    arithmetic,
    compiled,
    elementary,
    geometry,
    load_table,
    logic,
    operations,
    permitted,
    whole,
)
from codegen.intervals.accuracy import Ulp
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.interpreter import reinterpreted
from codegen.intervals.permit import DEPTH
from codegen.intervals.values import Range, Whole
from conformance.unit.support.sources import library_of
from targets import TARGETS

INF = np.inf
SEED = 20_261
EVERY_WORD = 2**32 - 1


def ends(*pairs: tuple[float, float]) -> tuple[Any, Any]:
    low, high = zip(*pairs, strict=True)
    return np.array(low, np.float64), np.array(high, np.float64)


def pairs(found: Range | Whole) -> list[tuple[float, float]]:
    return list(zip(found.low.tolist(), found.high.tolist(), strict=True))


def test_least_and_most_are_anything_only_where_an_operand_is() -> None:
    a = Range(*ends((0.0, 1.0), (2.0, 3.0)), np.array([1, 0], np.int16))
    b = Range(*ends((0.5, 4.0), (0.5, 4.0)))
    assert pairs(arithmetic.smaller(a, b)) == [(-INF, INF), (0.5, 3.0)]
    assert pairs(arithmetic.larger(a, b)) == [(-INF, INF), (2.0, 4.0)]


def test_clamp_with_crossed_ends_may_give_either() -> None:
    x = Range(*ends((0.0, 0.5), (0.0, 0.5), (0.0, 9.0), (0.0, 9.0)))
    least = Range(*ends((2.0, 2.0), (0.25, 0.25), (2.0, 2.0), (1.0, 3.0)))
    most = Range(*ends((1.0, 1.0), (4.0, 4.0), (1.0, 1.0), (2.0, 4.0)))
    assert pairs(arithmetic.clamp(x, least, most)) == [(1.0, 2.0), (0.25, 0.5), (1.0, 2.0), (1.0, 4.0)]


def test_angle_on_the_negative_axis_has_either_sign() -> None:
    y = Range(*ends((-1.0, 1.0), (-1.0, 1.0), (0.5, 1.0)))
    x = Range(*ends((-2.0, -1.0), (1.0, 2.0), (-2.0, -1.0)))
    context = Context(load_table("opencl"), CauseBook(), 3)
    low, high = zip(*pairs(elementary.arc_tangent(context, y, x)), strict=True)
    assert low[0] <= -math.pi and high[0] >= math.pi
    assert low[1] > -1.0 and high[1] < 1.0
    assert low[2] > 2.0 and high[2] < 3.0


@pytest.mark.parametrize("name", [n for n in TABLES if load_table(n).row("/").zero])
def test_zero_may_be_divided_though_the_promise_begins_above(name: str) -> None:
    table = load_table(name)
    row = table.row("/")
    smallest = 2.0 ** row.magnitude["x"][0]
    context = Context(table, CauseBook(), 3)
    x = Range(*ends((0.0, 0.0), (smallest / 4.0, smallest / 2.0), (0.0, 1.0)))
    found = arithmetic.divide(context, row, x, Range(*ends((1.0, 2.0), (1.0, 2.0), (1.0, 2.0))))
    assert found.cause is not None
    assert (found.cause > 0).tolist() == [False, True, True]
    assert pairs(found)[0] == (0.0, 0.0)


@pytest.mark.parametrize("name", TABLES)
def test_interval_over_one_number_is_as_wide_as_its_quotients(name: str) -> None:
    table, divisor = load_table(name), np.array([4.0, -4.0])
    x = Range(*ends((1.0, 8.0), (1.0, 8.0)))
    row = table.row("/")
    assert isinstance(row.accuracy, Ulp)
    near = (row.accuracy.ulps + 1.0) * float(np.finfo(np.float32).eps)
    found = arithmetic.divide(Context(table, CauseBook(), 2), row, x, Range(divisor, divisor))
    for (low, high), (least, most) in zip(pairs(found), ((0.25, 2.0), (-2.0, -0.25)), strict=True):
        assert (low, high) == pytest.approx((least, most), rel=near)
        assert low <= least and high >= most


@pytest.mark.parametrize("op", ["+", "-", "*", "^", "|", "&", "<<", ">>"])
def test_known_lanes_of_integers_stay_exact(op: str) -> None:
    """In lanes between two ends the result is one of those that the numbers between them give."""
    a = Whole(np.array([12, 12]), np.array([12, 14]), False)
    b = Whole(np.array([3, 3]), np.array([3, 3]), False)
    exact = {"+": 15, "-": 9, "*": 36, "^": 15, "|": 15, "&": 0, "<<": 96, ">>": 1}[op]
    (known, between) = pairs(whole.binary(op, a, b))
    assert known == (exact, exact)
    assert between[0] <= exact <= between[1]


def test_bits_of_what_may_be_zero_or_no_number() -> None:
    one, two = 0x3F800000, 0x40000000
    x = Range(*ends((-1.0, 1.0), (1.0, 2.0), (-2.0, -1.0), (-INF, INF)))
    every = (0, EVERY_WORD)
    assert pairs(whole.float_to_bits(x)) == [every, (one, two), (one + 2**31, two + 2**31), every]
    x.cause = np.array([0, 0, 0, 1], np.int16)
    assert pairs(whole.float_to_bits(x)) == [every, (one, two), (one + 2**31, two + 2**31), every]
    point = np.array([0.0, 1.0])
    assert pairs(whole.float_to_bits(Range(point, point))) == [every, (one, one)]
    decided = np.array([1.0, -2.0])
    for words in (x, Range(point, point), Range(decided, decided)):
        assert not whole.float_to_bits(words).is_signed


def test_unsigned_words_up_to_the_largest_signed_one_keep_their_number() -> None:
    most = 2**31 - 1
    words = Whole(np.array([0, 5, 7]), np.array([most, most + 1, 9]), False)
    found = reinterpreted(words, is_signed=True)
    assert pairs(found) == [(0, most), (-(2**31), most), (7, 9)]
    signed = Whole(np.array([0, -1, 7]), np.array([5, 5, most]), True)
    assert pairs(reinterpreted(signed, is_signed=False)) == [(0, 5), (0, EVERY_WORD), (7, most)]


def test_integer_over_zero_is_what_wgsl_makes_of_it() -> None:
    """The dividend itself, and no remainder (WGSL 8.7, Arithmetic Expressions); others say nothing."""
    a, b = np.array([7, 7]), np.array([0, 2])
    for op, known in (("//", [7, 3]), ("%", [0, 1])):
        found = whole.binary(op, Whole(a, a, False), Whole(b, b, False))
        assert found.low.tolist() == found.high.tolist() == known


def test_ends_below_the_normal_numbers_lie_on_the_grid_where_nothing_is_flushed() -> None:
    context = Context(replace(load_table("opencl"), flush=False), CauseBook(), 2)
    step = float(np.finfo(np.float32).smallest_subnormal)
    found = arithmetic.settle(context, *ends((1.25 * step, 1.75 * step), (-2.5 * step, 2.5 * step)), None)
    assert pairs(found) == [(step, 2.0 * step), (-3.0 * step, 3.0 * step)]


@pytest.mark.parametrize("name", TABLES)
def test_boxes_of_vectors_hold_every_direction_in_them(name: str) -> None:
    random = np.random.default_rng(SEED)
    corners = np.sort(random.uniform(-1.0, 1.0, (2, 3, 60)).astype(np.float32).astype(np.float64), axis=0)
    corners[:, :, ::2] *= np.array([1.0, 1e3, 1e-3])[:, None]  # boxes longer than wide among them
    context = Context(load_table(name), CauseBook(), corners.shape[2])
    with np.errstate(all="ignore"):
        found = geometry.normalize(context, tuple(Range(*corners[:, k].copy()) for k in range(3)))
    for _ in range(40):
        inside = corners[0] + random.choice([0.0, 0.5, 1.0], (3, 1)) * (corners[1] - corners[0])
        directions = inside / np.linalg.norm(inside, axis=0)
        for component, x in zip(found, directions, strict=True):
            assert (component.low <= x).all() and (x <= component.high).all()


def test_known_integer_stays_one_number_as_a_float() -> None:
    context = Context(load_table("wgsl"), CauseBook(), 2)
    known, between = np.array([3, 2**20]), np.array([4, 2**20])
    for exact in (known, np.array([-(2**24), 0]), np.array([1, 2**24])):
        assert logic.to_float(context, Whole(exact, exact, True)).is_point
    found = logic.to_float(context, Whole(known, between, False))
    assert pairs(found) == [(3.0, 4.0), (2.0**20, 2.0**20)] and not found.is_point


@pytest.mark.parametrize("round_", [logic.floor, lambda here, x: logic.to_integer(here, x, True)])
def test_integer_of_all_that_a_lane_may_be_is_one_number(round_: Any) -> None:
    here = Context(load_table("wgsl"), CauseBook(), 2)
    found = round_(here, Range(*ends((1.25, 1.75), (4.0, 4.5))))
    assert found.is_point and pairs(found) == [(1.0, 1.0), (4.0, 4.0)]
    assert here.forks == 1
    assert not round_(here, Range(*ends((1.25, 1.75), (4.0, 5.0)))).is_point


def test_operation_without_a_form_is_told() -> None:
    context, one = Context(load_table("wgsl"), CauseBook(), 1), np.array([1])
    for x in (Range(one * 1.0, one * 1.0), Whole(one, one, False)):
        with pytest.raises(NotImplementedError, match="no interval form of cbrt"):
            operations.scalar_builtin(context, "cbrt", x)


@pytest.mark.parametrize("other", [0, 1])
def test_short_vectors_have_a_direction_whatever_others_have(other: int) -> None:
    context = Context(load_table("opencl"), CauseBook(), 3)
    middle = (-INF, INF) if other else (0.0, 0.0)
    codes = np.array([0, 1, 0], np.int16) if other else None
    x = Range(*ends((0.5, 0.5), middle, (0.0, 0.0)), codes)
    zero = Range(*ends((0.0, 0.0), (0.0, 0.0), (0.0, 0.0)))
    with np.errstate(invalid="ignore"):
        components = geometry.normalize(context, (x, zero, zero))
    for found in components:
        assert found.cause is not None
        assert (found.cause > 0).tolist() == [False, True, True]


def test_absolute_value_of_anything_is_anything() -> None:
    found = arithmetic.absolute(Range(*ends((-3.0, 2.0), (-INF, INF)), np.array([0, 1], np.int16)))
    assert pairs(found) == [(0.0, 3.0), (-INF, INF)]


def test_lane_with_too_many_ways_keeps_the_hull(tmp_path: Path) -> None:
    """WGSL's sine is off by 2^-11, so that its thousandfold may lie on either side of some integers."""
    one = "    p = sin(x) * {0}.0\n    t = floor(p) - p\n"
    two = "    q = sin(y) * {0}.0\n    u = floor(q) - q\n"
    inputs = {"x": np.array([0.7], np.float32), "y": np.array([0.3], np.float32)}
    widths = {}
    for scale in (4000, 20000):
        for name, body in {"once": one + "    u = y\n", "twice": one + two}.items():
            text = f"def probe(x: X, y: X) -> f32:\n{body.format(scale)}    return t + u\n"
            library = library_of(tmp_path / f"{name}{scale}", text)
            followed: Any = permitted(library, "probe", inputs, "wgsl")
            hull: Any = permitted(library, "probe", inputs, "wgsl", follow_forks=False)
            widths[name, scale] = float((followed.high - followed.low)[0] / (hull.high - hull.low)[0])
    assert widths["once", 4000] < 0.5 and widths["once", 20000] < 0.5
    assert widths["twice", 4000] < 0.5
    assert widths["twice", 20000] == 1.0


def test_lane_is_followed_through_as_many_forks_as_are_promised(tmp_path: Path) -> None:
    """Each comparison leaves one way open; only the last one tells that 1 is not divided by 0."""
    inputs = {"x": np.array([0.7], np.float32)}  # WGSL's sine is off by 2^-11, its multiple by 9
    first = math.floor(math.sin(0.7) * 20000.0) - DEPTH // 2
    steps = "".join(f"    y{k} = 1.0 if y >= {first + k}.0 else 2.0\n" for k in range(DEPTH - 1))
    total = " + ".join(f"y{k}" for k in range(DEPTH - 1))
    last = f"    s = 1.0 if y >= {first + DEPTH}.0 else -1.0\n"
    text = f"def probe(x: X) -> f32:\n    y = sin(x) * 20000.0\n{steps}{last}    return {total} + 1.0 / s\n"
    library = library_of(tmp_path, text)
    guaranteed = [
        permitted(library, "probe", inputs, "wgsl", follow_forks=follow).guaranteed.tolist()
        for follow in (True, False)
    ]
    assert guaranteed == [[True], [False]]


def test_ways_beyond_those_that_are_followed_count_with_their_hull(tmp_path: Path) -> None:
    """The sine lies below all thresholds or above any number of them."""
    count = DEPTH + 2
    first = math.floor(math.sin(0.7) * 20000.0) - count // 2
    steps = "".join(f"    y{k} = 1.0 if y >= {first + k}.0 else 2.0\n" for k in range(count))
    total = " + ".join(f"y{k}" for k in range(count))
    text = f"def probe(x: X) -> f32:\n    y = sin(x) * 20000.0\n{steps}    return {total}\n"
    found: Any = permitted(library_of(tmp_path, text), "probe", {"x": np.array([0.7], np.float32)}, "wgsl")
    assert found.low[0] <= count and found.high[0] >= 2 * count


def test_no_loop_is_compiled_for_few_lanes_nor_without_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not compiled.wanted(1)
    monkeypatch.setattr(compiled, "found", lambda: None)
    assert not compiled.wanted(2**30)


@pytest.mark.parametrize(("op", "expected"), [("and", [1.0, 2.0, 2.0, 2.0]), ("or", [1.0, 1.0, 1.0, 2.0])])
def test_truth_of_two_comparisons(op: str, expected: list[float], tmp_path: Path) -> None:
    text = f"def probe(x: X, y: X) -> f32:\n    return 1.0 if x > 0.0 {op} y > 0.0 else 2.0\n"
    inputs = {"x": np.array([3, 3, -3, -3], np.float32), "y": np.array([3, -3, 3, -3], np.float32)}
    found: Any = permitted(library_of(tmp_path, text), "probe", inputs, "wgsl")
    assert found.low.tolist() == found.high.tolist() == expected


def test_every_target_has_its_table() -> None:
    assert dict(DEFAULT_TABLES) == {target: target for target in TARGETS}
