"""Numbers of the float32 grid, sums on it, and what is granted to float64: at the very places where they end.

Plan. Against fractions, which are exact, and against the limits that the documentation names.
  sums      of floats, and of a float and a product, go to the floats on either side; operands that all lanes
            share, on either side
  reach     ends and least magnitude; what is ordinary and what float64 adds exactly, up to the limits
  granted   8 ULP of float64 on a value, 2^-20 on a number of ULP: no more, no less, on both sides of 0
  choices   by bits; nearest floats, ties to even
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from codegen.intervals import arithmetic, load_table, numbers
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.products import unrounded
from codegen.intervals.values import Product, Range

SEED = 20_264
SMALLEST, LARGEST = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)
INF, NAN = float("inf"), float("nan")


def neighbours(exact: Fraction) -> tuple[float, float]:
    """The floats at or below and at or above a number."""
    near = np.float32(float(exact))
    low = near if Fraction(float(near)) <= exact else np.nextafter(near, np.float32(-INF))
    high = near if Fraction(float(near)) >= exact else np.nextafter(near, np.float32(INF))
    return float(low), float(high)


def singles(rng: np.random.Generator, count: int, exponents: int) -> Any:
    found = rng.choice([-1.0, 1.0], count) * np.ldexp(
        rng.uniform(1.0, 2.0, count), rng.integers(-exponents, exponents + 1, count)
    )
    return found.astype(np.float32).astype(np.float64)


def operands_of_sums() -> list[tuple[Any, Any]]:
    rng = np.random.default_rng(SEED)
    a, b, c = (singles(rng, 150, 35) for _ in range(3))
    return [(a, b), (a, b * c), (b * c, a), (a, -a), (a, a * 2.0**-60), (-(a * 2.0**-70), a)]


def test_sums_go_to_the_floats_on_either_side() -> None:
    for x, y in operands_of_sums():
        expected = [neighbours(Fraction(p) + Fraction(q)) for p, q in zip(x, y, strict=True)]
        assert numbers.sum_down(x, y).tolist() == [low for low, _ in expected]
        assert numbers.sum_up(x, y).tolist() == [high for _, high in expected]


def test_sums_with_what_all_lanes_share() -> None:
    for tiny in (2.0**-70, -(2.0**-70), 2.0**-30, 0.0):
        x, shared = np.array([1.0, 3.0, -1.0, 0.5]), np.array([tiny])
        expected = [neighbours(Fraction(p) + Fraction(tiny)) for p in x]
        for found in ((numbers.sum_down(x, shared), 0), (numbers.sum_down(shared, x), 0)):
            assert found[0].tolist() == [low for low, _ in expected]
        for found in ((numbers.sum_up(x, shared), 1), (numbers.sum_up(shared, x), 1)):
            assert found[0].tolist() == [high for _, high in expected]


def test_sums_of_small_magnitudes_of_both_signs() -> None:
    """Beside a float on the side of 0 and on the other, where neighbours are at different distances."""
    for one in (1.0, -1.0, 2.0**-100, -(2.0**100)):
        for part in (2.0**-80, -(2.0**-80)):
            x, y = np.array([one]), np.array([one * part])
            low, high = neighbours(Fraction(one) + Fraction(one * part))
            assert (numbers.sum_down(x, y)[0], numbers.sum_up(x, y)[0]) == (low, high)
            assert (numbers.sum_down(y, x)[0], numbers.sum_up(y, x)[0]) == (low, high)


REACHES = [
    ((1.0, 2.0), (3.0, 5.0), (1.0, 5.0, 1.0)),
    ((-3.0, -5.0), (-2.0, -4.0), (-5.0, -2.0, 2.0)),
    ((-5.0, -4.0), (1.0, 2.0), (-5.0, 2.0, 1.0)),
    ((-1.0, -4.0), (3.0, 2.0), (-4.0, 3.0, 1.0)),
    ((0.0, 2.0), (1.0, 3.0), (0.0, 3.0, 0.0)),
    ((-2.0, -3.0), (0.0, -1.0), (-3.0, 0.0, 0.0)),
    ((-0.5, -0.75), (0.5, 0.25), (-0.75, 0.5, 0.25)),
    ((-INF, 1.0), (INF, 2.0), (-INF, INF, 1.0)),
]


@pytest.mark.parametrize(("low", "high", "expected"), REACHES)
def test_reach(low: tuple[float, ...], high: tuple[float, ...], expected: numbers.Reach) -> None:
    assert numbers.reach(np.array(low), np.array(high)) == expected
    known = np.array(low)
    assert numbers.reach(known, known) == (min(low), max(low), min(abs(x) for x in low))


def test_ordinary_numbers_end_at_the_smallest_and_the_largest() -> None:
    below = float(np.nextafter(SMALLEST, 0.0))
    assert numbers.usual((SMALLEST, LARGEST, SMALLEST))
    assert numbers.usual((-LARGEST, -SMALLEST, SMALLEST))
    assert numbers.usual((-LARGEST, LARGEST, 1.0))
    for found in ((below, 1.0, below), (-1.0, 1.0, 0.0), (1.0, INF, 1.0), (-INF, 1.0, 1.0)):
        assert not numbers.usual(found)
    for found in ((NAN, 1.0, 1.0), (1.0, NAN, 1.0), (1.0, 1.0, NAN), (2.0 * -LARGEST, 1.0, 1.0)):
        assert not numbers.usual(found)


def test_float64_adds_exactly_up_to_a_ratio() -> None:
    ratio = 2.0**27
    one = (1.0, 1.0, 1.0)
    for far, exact in ((ratio, True), (ratio * 1.001, False), (ratio / 2.0, True)):
        for reach in ((1.0, far, 1.0), (-far, 1.0, 1.0), (-far, -1.0, 1.0), (-far, far, 1.0)):
            assert numbers.exact_sums(reach, one) == exact
            assert numbers.exact_sums(one, reach) == exact
    smallest = (SMALLEST, 1e-37, SMALLEST)
    assert numbers.exact_sums(smallest, smallest)
    assert not numbers.exact_sums((SMALLEST / 2.0, 1e-38, SMALLEST / 2.0), smallest)
    assert not numbers.exact_sums(smallest, (SMALLEST / 2.0, 1e-38, SMALLEST / 2.0))
    assert not numbers.exact_sums(one, (0.0, 1.0, 0.0))


@pytest.mark.parametrize("is_point", [True, False])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_is_granted_to_float64(sign: float, is_point: bool) -> None:
    """A float may be meant that is 8 ULP of float64 away, relative to the value, and no further one."""
    margin = 2.0**-49
    for share, held in ((0.9, True), (1.2, False)):
        for value in (1.5, 1.25, 3.0e10, 1.75e-20):
            value = float(np.float32(value))
            above = np.array([sign * value * (1.0 + share * margin)])
            below = np.array([sign * value * (1.0 - share * margin)])
            for near in (above, below):
                with np.errstate(over="ignore"):  # of limits that lie beyond every float
                    ends = arithmetic.within_ulp(near, near if is_point else near.copy(), 0.0, 0.0)
                assert (ends[0][0] <= sign * value <= ends[1][0]) == held


@pytest.mark.parametrize("is_point", [True, False])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_is_granted_to_numbers_of_ulp(sign: float, is_point: bool) -> None:
    step, ulps = 2.0**-23, 3.0
    for share, held in ((0.0, True), (0.9, True), (1.1, False)):
        past = ulps * step * 2.0**-20 * share
        for value in (1.5 + past, 1.5 - past):
            x = np.array([sign * value])
            low, high = arithmetic.within_ulp(x, x if is_point else x.copy(), ulps, ulps)
            reached = sign * (1.5 - ulps * step), sign * (1.5 + ulps * step)
            least, most = min(reached), max(reached)
            if value > 1.5 or not share:  # the further end of the inner side has to be reached
                assert ((low[0] <= least) if sign > 0 else (high[0] >= most)) == held
            if value < 1.5 or not share:
                assert ((high[0] >= most) if sign > 0 else (low[0] <= least)) == held


def test_different_numbers_of_ulp_below_and_above() -> None:
    step, x = 2.0**-23, np.array([1.5, -1.5])
    for ends in ((x, x), (x, x.copy())):
        low, high = arithmetic.within_ulp(*ends, 2.0, 5.0)
        assert low.tolist() == [1.5 - 2.0 * step, -1.5 - 2.0 * step]
        assert high.tolist() == [1.5 + 5.0 * step, -1.5 + 5.0 * step]


def test_ulp_of_the_larger_spacing_reach_across_a_power_of_two() -> None:
    """2.5 ULP of a number whose float neighbours are farther apart than those of the end."""
    step = 2.0**-23
    low, high = np.array([1.0 - step / 2.0, -1.0 - step]), np.array([1.0 + step, -1.0 + step / 2.0])
    first, last = arithmetic.within_ulp(low, high, 2.5, 2.5)
    # 1.0 itself may be off by 2.5 of the larger steps, and no number by more of them than the end.
    assert 1.0 - 3.0 * step <= first[0] <= 1.0 - 2.5 * step
    assert -1.0 + 2.5 * step <= last[1] <= -1.0 + 3.0 * step
    assert last[0] == 1.0 + 3.0 * step and first[1] == -1.0 - 3.0 * step


def test_sign_is_kept_within_any_number_of_ulp() -> None:
    """A quotient that is positive stays so, 0 stays 0, and what has both signs keeps neither."""
    low, high = np.array([1e-45, -1e-45, 0.0, -1.0, 0.0, -2.0]), np.array([1.0, -1e-46, 0.0, 1.0, 1.0, 0.0])
    low[0], high[1] = 2.0**-149, -(2.0**-149)
    first, last = arithmetic.within_ulp(low, high, 1e9, 1e9)
    assert (first >= 0.0).tolist() == [True, False, True, False, True, False]
    assert (last <= 0.0).tolist() == [False, True, True, False, False, True]
    tiny = np.array([-1e-60, 1e-60])
    for ends in ((tiny, tiny), (tiny, tiny.copy())):  # which is no limit to either side
        first, last = arithmetic.within_ulp(*ends, 1e9, 1e9)
        assert first[0] < -0.99e9 * 2.0**-149 and last[1] > 0.99e9 * 2.0**-149
    one = np.array([1e-30, -1e-30, 0.0])
    first, last = arithmetic.within_ulp(one, one, 1e9, 1e9)
    assert (first >= 0.0).tolist() == [True, False, True] and (last <= 0.0).tolist() == [False, True, True]


def test_nearest_ties_go_to_even() -> None:
    step = 2.0**-23
    x = np.array([1.0 + step / 2.0, 1.0 + 1.5 * step, 1.0 + 0.6 * step, -1.0 - 0.4 * step, 1e39])
    with np.errstate(over="ignore"):
        found = numbers.nearest(x)
    assert found.tolist() == [1.0, 1.0 + 2.0 * step, 1.0 + step, -1.0, INF]
    assert found.dtype == np.float64


def settled(name: str, low: list[float], high: list[float] | None = None, flush: bool = True) -> Range:
    context = Context(replace(load_table(name), flush=flush), CauseBook(), len(low))
    first = np.array(low)
    return arithmetic.settle(context, first, first if high is None else np.array(high))


def test_results_below_the_normal_numbers_reach_0_and_the_smallest() -> None:
    tiny = SMALLEST / 3.0
    low = [tiny, -tiny, -tiny, 0.0, SMALLEST, -SMALLEST, 1.0, -1.0]
    high = [2.0 * tiny, -tiny / 2.0, tiny, tiny, 1.0, tiny, 2.0, -SMALLEST]
    found = settled("wgsl", low, high)
    assert found.low.tolist() == [0.0, -SMALLEST, -SMALLEST, 0.0, SMALLEST, -SMALLEST, 1.0, -1.0]
    assert found.high.tolist() == [SMALLEST, 0.0, SMALLEST, SMALLEST, 1.0, SMALLEST, 2.0, -SMALLEST]
    assert found.cause is None and found.reach == numbers.reach(found.low, found.high)


def test_known_results_stay_known_unless_they_may_flush() -> None:
    assert settled("opencl", [0.0, 1.0]).is_point
    assert settled("opencl", [2.0, 1.0]).is_point
    found = settled("opencl", [SMALLEST / 2.0, 1.0])
    assert not found.is_point and found.low.tolist() == [0.0, 1.0] and found.high.tolist() == [SMALLEST, 1.0]
    kept = settled("opencl", [2.0**-149, 1.0], flush=False)
    assert kept.is_point and kept.low.tolist() == [2.0**-149, 1.0]


def test_overflow_is_anything() -> None:
    found = settled("wgsl", [1.0, -INF, LARGEST, -LARGEST, NAN], [LARGEST, 1.0, INF, LARGEST, 1.0])
    assert found.cause is not None and found.cause.tolist() == [0, 1, 1, 0, 1]
    assert found.low.tolist() == [1.0, -INF, -INF, -LARGEST, -INF]
    assert found.high.tolist() == [LARGEST, INF, INF, LARGEST, INF]


def test_earlier_causes_stay() -> None:
    context = Context(load_table("wgsl"), CauseBook(), 3)
    codes = np.array([0, 7, 7], np.int16)
    found = arithmetic.settle(context, np.array([1.0, 1.0, 1.0]), np.array([INF, INF, 2.0]), codes)
    assert found.cause is not None and found.cause.tolist() == [1, 7, 7]
    assert found.low.tolist() == [-INF] * 3 and found.high.tolist() == [INF] * 3
    assert [cause.reason for cause in context.book.causes] == ["the result may overflow"]
    found = arithmetic.settle(context, np.ones(3), np.full(3, 2.0), codes)
    assert found.low.tolist() == [1.0, -INF, -INF] and found.high.tolist() == [2.0, INF, INF]


def test_inputs_below_the_normal_numbers_may_be_read_as_0() -> None:
    given = np.array([1e-40, -1e-40, 0.0, 1.0], np.float32)
    tiny = float(np.float32(1e-40))
    context = Context(load_table("wgsl"), CauseBook(), 4)
    found = arithmetic.from_input(context, given)
    assert found.low.tolist() == [0.0, -tiny, 0.0, 1.0] and found.high.tolist() == [tiny, 0.0, 0.0, 1.0]
    assert found.cause is None and not context.book.causes
    plain = arithmetic.from_input(context, np.array([0.0, 1.0], np.float32))
    assert plain.is_point and plain.low.tolist() == [0.0, 1.0]


@pytest.mark.parametrize("others", [[1.0], [1e-40], [0.0]])
def test_inputs_that_are_not_finite_are_anything(others: list[float]) -> None:
    context = Context(load_table("wgsl"), CauseBook(), 3 + len(others))
    found = arithmetic.from_input(context, np.array([INF, -INF, NAN, *others], np.float32))
    assert found.cause is not None and found.cause.tolist() == [1, 1, 1] + [0] * len(others)
    assert [cause.reason for cause in context.book.causes] == ["the input is not finite"]
    told = float(np.float32(others[0]))
    assert found.low.tolist() == [-INF] * 3 + [told if told == 1.0 else 0.0]
    assert found.high.tolist() == [INF] * 3 + [told]


def test_negated_value_is_known_as_well_as_the_value() -> None:
    known = np.array([1.0, -2.0])
    one = np.ones(1)
    kept = Product((np.array([-4.0, 0.5]), np.array([2.5, 6.0])), (one, one))
    box = Range(np.array([-3.0, 1.0]), np.array([2.0, 5.0]), None, kept)
    for x in (Range(known, known), box):
        for asked in (False, True):
            if asked:
                assert x.reach == numbers.reach(x.low, x.high)
            found = arithmetic.negate(x)
            assert found.is_point == x.is_point
            assert found.low.tolist() == (-x.high).tolist() and found.high.tolist() == (-x.low).tolist()
            assert found.reach == numbers.reach(found.low, found.high)
    assert found.product is not None
    assert [end.tolist() for end in unrounded(found.product)] == [[-2.5, -6.0], [4.0, -0.5]]
    again = arithmetic.negate(found).product
    assert again is not None and [end.tolist() for end in unrounded(again)] == [[-4.0, 0.5], [2.5, 6.0]]
