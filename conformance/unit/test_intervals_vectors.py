"""Vectors: dot, cross, length and normalize have the very ends that fractions give.

Plan. Small vectors of intervals, every operation of which is done here once more with fractions and directed
rounding, or with the exact values and the promise of the row.
  dot        rounded: the hull of all orders and groupings of two, three and four products, each sum rounded
             to both sides; scaled: exact ends and the stated share of the largest square, squares of one
             vector never below 0
  cross      rounded: two products and their difference; scaled: as above
  length     ULP for each number of components
  normalize  ULP: each component grows with its own and falls with the others; formulas: those that are named,
             and the hull of both where two are
  cut        a component is no more than its vector's length, where that does not vanish
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from codegen.intervals import arithmetic, elementary, geometry, load_table
from codegen.intervals.accuracy import Inherited, Scaled, Ulp
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.tables import FORMULAS, Table
from codegen.intervals.values import Range
from conformance.unit.support.tolerances import tolerance

SEED = 20_266
EPSILON = Fraction(1, 2**23)
LANES = 12
Ends = tuple[Fraction, Fraction]


def directed(exact: Fraction, up: bool) -> Fraction:
    """The float32 beside a number, on one side."""
    near = np.float32(float(exact))
    if (Fraction(float(near)) < exact) == up and Fraction(float(near)) != exact:
        near = np.nextafter(near, np.float32(np.inf if up else -np.inf))
    return Fraction(float(near))


def rounded(ends: Ends) -> Ends:
    return directed(ends[0], False), directed(ends[1], True)


def product(a: Ends, b: Ends, squared: bool = False) -> Ends:
    corners = [x * y for x in a for y in b]
    low = Fraction(0) if squared and a[0] < 0 < a[1] else min(x * x for x in a) if squared else min(corners)
    return low, max(corners)


def plus(a: Ends, b: Ends) -> Ends:
    return a[0] + b[0], a[1] + b[1]


def minus(a: Ends, b: Ends) -> Ends:
    return a[0] - b[1], a[1] - b[0]


def hull(parts: list[Ends]) -> Ends:
    return min(p[0] for p in parts), max(p[1] for p in parts)


def any_order(terms: list[Ends]) -> Ends:
    """All ways to split the terms in two, again and again."""
    if len(terms) == 1:
        return terms[0]
    found = []
    for mask in range(1, 2 ** (len(terms) - 1)):
        one, other = (
            [t for k, t in enumerate(terms) if bool(mask >> k & 1) == side] for side in (True, False)
        )
        found.append(rounded(plus(any_order(one), any_order(other))))
    return hull(found)


def vector(rng: np.random.Generator, size: int, points: bool = False) -> tuple[Range, ...]:
    found = []
    for _ in range(size):
        a = (rng.uniform(-1.0, 1.0, LANES) * 10.0 ** rng.integers(-2, 3, LANES)).astype(np.float32)
        b = np.where(np.arange(LANES) % 3 == 0, a, a + np.float32(0.75) * rng.uniform(0.0, 1.0, LANES))
        low, high = a.astype(np.float64), np.maximum(a, b.astype(np.float32)).astype(np.float64)
        found.append(Range(low, low if points else high))
    return tuple(found)


def box(x: Range, lane: int) -> Ends:
    return Fraction(float(x.low[lane])), Fraction(float(x.high[lane]))


def context(table: Table | str) -> Context:
    return Context(load_table(table) if isinstance(table, str) else table, CauseBook(), LANES)


def within(steps: int) -> float:
    """Relative distance of so many floats, the least there is between two, and a quarter of one more."""
    return (steps + 0.25) * 2.0**-24


def assert_ends(found: Range, expected: list[Ends], steps: int = 0) -> None:
    """The ends, or so many floats further out: for what float64 may lose on the way."""
    assert found.cause is None
    for lane, (low, high) in enumerate(expected):
        a, b = float(directed(low, False)), float(directed(high, True))
        assert (float(found.low[lane]), float(found.high[lane])) == pytest.approx(
            (a, b), rel=within(steps), abs=0.0
        ), lane
        assert not steps or (found.low[lane] <= b and found.high[lane] >= a)


@pytest.mark.parametrize("points", [False, True])
@pytest.mark.parametrize("size", [2, 3, 4])
@pytest.mark.parametrize("alike", [0, 1, 4])
def test_dot_in_every_order(size: int, alike: int, points: bool) -> None:
    """Of different vectors, of those that share a component, and of one with itself."""
    rng = np.random.default_rng(SEED + size)
    a, b = vector(rng, size, points), vector(rng, size, points)
    b = (*a[:alike], *b[alike:])
    expected = [
        any_order([rounded(product(box(x, k), box(y, k), x is y)) for x, y in zip(a, b, strict=True)])
        for k in range(LANES)
    ]
    assert_ends(geometry.dot(context("wgsl"), a, b), expected)
    assert_ends(geometry.dot(context("wgsl"), b, a), expected)


def scaled(accuracy: Scaled, components: tuple[Range, ...], size: int, lane: int) -> Fraction:
    largest = max(abs(end) for c in components for end in box(c, lane))
    return largest**2 * (Fraction(accuracy.epsilons) + Fraction(accuracy.per_component) * size) * EPSILON


@pytest.mark.parametrize("size", [2, 3, 4])
@pytest.mark.parametrize("alike", [0, 1, 4])
def test_dot_off_by_a_share_of_the_largest_square(size: int, alike: int) -> None:
    table = load_table("opencl")
    accuracy = table.row("dot").accuracy
    assert isinstance(accuracy, Scaled)
    rng = np.random.default_rng(SEED + size)
    a, b = vector(rng, size), vector(rng, size)
    b = (*a[:alike], *b[alike:])
    found = geometry.dot(context(table), a, b)
    for k in range(LANES):
        parts = [product(box(x, k), box(y, k), x is y) for x, y in zip(a, b, strict=True)]
        low, high = (sum((p[e] for p in parts), Fraction(0)) for e in (0, 1))
        slack = scaled(accuracy, (*a, *b), size, k)
        low, high = low - slack, high + slack
        if alike >= size:
            low = max(low, Fraction(0))
        near(found, k, low, high)


def near(found: Range, lane: int, low: Fraction, high: Fraction) -> None:
    """The last floats inside, or beside an end that is itself a float."""
    for end, exact in ((found.low[lane], low), (found.high[lane], high)):
        size = max(abs(float(exact)), 2.0**-100)
        assert abs(float(end) - float(exact)) <= size * 2.0**-22, (lane, end, float(exact))
    granted = abs(high - low) * Fraction(1, 2**40) + Fraction(1, 2**60)
    assert Fraction(float(found.low[lane])) >= low - granted - abs(low) * Fraction(1, 2**40)
    assert Fraction(float(found.high[lane])) <= high + granted + abs(high) * Fraction(1, 2**40)


PAIRS = ((1, 2), (2, 0), (0, 1))


@pytest.mark.parametrize("points", [False, True])
def test_cross_rounded(points: bool) -> None:
    rng = np.random.default_rng(SEED)
    a, b = vector(rng, 3, points), vector(rng, 3, points)
    found = geometry.cross(context("wgsl"), a, b)
    for component, (i, j) in zip(found, PAIRS, strict=True):
        expected = [
            rounded(
                minus(
                    rounded(product(box(a[i], k), box(b[j], k))), rounded(product(box(a[j], k), box(b[i], k)))
                )
            )
            for k in range(LANES)
        ]
        assert_ends(component, expected)


def test_cross_off_by_a_share_of_the_largest_square() -> None:
    table = load_table("opencl")
    accuracy = Scaled(3.0, 0.5)  # of the table, and a part for each of the three components
    table = replace(table, rows={**table.rows, "cross": replace(table.row("cross"), accuracy=accuracy)})
    rng = np.random.default_rng(SEED)
    a, b = vector(rng, 3), vector(rng, 3)
    found = geometry.cross(context(table), a, b)
    for component, (i, j) in zip(found, PAIRS, strict=True):
        for k in range(LANES):
            low, high = minus(product(box(a[i], k), box(b[j], k)), product(box(a[j], k), box(b[i], k)))
            slack = scaled(accuracy, (*a, *b), 3, k)
            near(component, k, low - slack, high + slack)


def assert_within(found: Range, lane: int, least: float, most: float, ulps: float) -> None:
    """The ends that so many ULP about two numbers have, or a float further out."""
    low, high = arithmetic.within_ulp(np.array([least]), np.array([most]), ulps, ulps)
    for end, beside in ((found.low[lane], low[0]), (found.high[lane], high[0])):
        assert abs(end - beside) <= float(np.spacing(np.float32(abs(beside))))


@pytest.mark.parametrize("size", [2, 3, 4])
def test_length_within_ulp(size: int) -> None:
    table = load_table("opencl")
    accuracy = table.row("length").accuracy
    assert isinstance(accuracy, Ulp) and accuracy.per_component
    x = vector(np.random.default_rng(SEED + size), size)
    found = geometry.length(context(table), x)
    ulps = accuracy.ulps + accuracy.per_component * size
    for k in range(LANES):
        squares = [product(box(c, k), box(c, k), True) for c in x]
        least, most = (math.sqrt(sum(s[e] for s in squares)) for e in (0, 1))
        assert_within(found, k, least, most, ulps)


@pytest.mark.parametrize("size", [2, 3, 4])
def test_normalize_within_ulp(size: int) -> None:
    """A component is least with its own lower end, and with the others far where that is positive."""
    table = load_table("opencl")
    accuracy = table.row("normalize").accuracy
    assert isinstance(accuracy, Ulp) and accuracy.per_component
    x = vector(np.random.default_rng(SEED + size), size)
    found = geometry.normalize(context(table), x)
    ulps = accuracy.ulps + accuracy.per_component * size
    for k in range(LANES):
        if sum(product(box(c, k), box(c, k), True)[0] for c in x) == 0:
            continue
        for j, component in enumerate(found):
            corners = []
            others = [box(c, k) for m, c in enumerate(x) if m != j]
            choices = [[*ends, Fraction(0)] if ends[0] < 0 < ends[1] else list(ends) for ends in others]
            for own in box(x[j], k):
                for rest in itertools.product(*choices):
                    size_ = math.sqrt(own**2 + sum(r**2 for r in rest))
                    corners.append(float(own) / size_ if size_ else 0.0)
            least, most = min(corners), max(corners)
            assert_within(component, k, least, most, ulps)


def with_formula(formula: str) -> Table:
    table = load_table("glsl")
    row = replace(table.row("normalize"), accuracy=Inherited(formula))
    return replace(table, rows={**table.rows, "normalize": row})


def away_from_0(rng: np.random.Generator, size: int) -> tuple[Range, ...]:
    low = rng.uniform(0.5, 2.0, (size, LANES)).astype(np.float32).astype(np.float64)
    wide = (rng.uniform(0.0, 0.1, (size, LANES)) * (np.arange(LANES) % 2)).astype(np.float32)
    return tuple(
        Range(p, (p + q).astype(np.float32).astype(np.float64)) for p, q in zip(low, wide, strict=True)
    )


@pytest.mark.parametrize("size", [2, 3])
def test_normalize_by_its_formulas(size: int) -> None:
    x = away_from_0(np.random.default_rng(SEED), size)
    quotient, factor, either = (with_formula(f) for f in FORMULAS[4:7])
    here = context(quotient)
    row, length = quotient.row("/"), geometry.length(here, x)
    root = elementary.inverse_square_root(here, geometry.dot(here, x, x))
    shares = [arithmetic.divide(here, row, c, length) for c in x]
    products = [arithmetic.multiply(here, c, root) for c in x]
    for table, ways in ((quotient, [shares]), (factor, [products]), (either, [shares, products])):
        found = geometry.normalize(context(table), x)
        for k, component in enumerate(found):
            low = np.min([way[k].low for way in ways], axis=0)
            high = np.max([way[k].high for way in ways], axis=0)
            most = 1.0 + 16.0 * 2.0**-23
            assert np.array_equal(component.low, np.maximum(low, -most))
            assert np.array_equal(component.high, np.minimum(high, most))


MOST = 1.0 + 2.0**-19


@pytest.mark.parametrize("formula", FORMULAS[4:7])
def test_components_are_cut_where_the_length_does_not_vanish(formula: str) -> None:
    """In a box about 0 in the other components, and one that is far longer than its vectors."""
    low, high = np.array([0.5, -4.0, -4.0, 1.0]), np.array([4.0, -0.5, 4.0, 1.0])
    x = Range(np.concatenate([low, np.full(8, 1.0)]), np.concatenate([high, np.full(8, 1.0)]))
    y = Range(np.full(LANES, 0.25), np.full(LANES, 0.25))
    found = geometry.normalize(context(with_formula(formula)), (x, y))
    assert found[0].cause is None
    assert found[0].low[:3].tolist() == [found[0].low[0], -MOST, -MOST] and found[0].low[0] > 0.0
    assert found[0].high[:3].tolist() == [MOST, found[0].high[1], MOST] and found[0].high[1] < 0.0
    assert found[0].low[3] == pytest.approx(1.0 / math.hypot(1.0, 0.25), abs=tolerance("normalised_by_table"))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_nothing_is_cut_where_squares_may_vanish(sign: float) -> None:
    share = Range(*np.sort(sign * np.array([[0.5, 0.5, 0.5], [3.0, 3.0, 3.0]]), axis=0))
    found = geometry._at_most_one(share, np.array([True, False, False]))
    assert (sign * np.array([found.low, found.high])).max(axis=0).tolist() == [3.0, MOST, MOST]
    codes = np.array([0, 0, 1], np.int16)
    found = geometry._at_most_one(Range(share.low, share.high, codes), np.array([False, True, False]))
    assert (sign * np.array([found.low, found.high])).max(axis=0).tolist() == [MOST, 3.0, 3.0]
    assert found.cause is codes
    small = Range(np.array([-MOST, 0.5]), np.array([0.5, MOST]))
    assert geometry._at_most_one(small, np.array([False, False])) is small


@pytest.mark.parametrize("name", ["wgsl", "vulkan", "opencl"])
def test_boxes_that_hold_the_zero_vector_are_anything(name: str) -> None:
    x = Range(np.array([-1.0, 0.0, 0.5]), np.array([1.0, 0.0, 1.0]))
    y = Range(np.array([0.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    here = Context(load_table(name), CauseBook(), 3)
    with np.errstate(all="ignore"):
        found = geometry.normalize(here, (x, y))
    for component in found:
        assert component.cause is not None and (component.cause > 0).tolist() == [True, True, False]
    reasons = {"wgsl": "the divisor may be 0", "vulkan": "x may be 0 or less"}
    (told,) = here.book.causes
    assert told.reason == reasons.get(name, "x may be the zero vector")
    if name == "opencl":
        assert told.operand == "x"


def test_what_may_be_anything_already_is_told_no_more() -> None:
    codes = np.array([7, 0], np.int16)
    x = Range(np.array([-np.inf, 1.0]), np.array([np.inf, 1.0]), codes)
    zero = Range(np.zeros(2), np.zeros(2))
    here = Context(load_table("opencl"), CauseBook(), 2)
    with np.errstate(all="ignore"):
        found = geometry.normalize(here, (x, zero))
    assert here.book.causes == [] and found[0].cause is not None and found[0].cause.tolist() == [7, 0]


def test_component_among_far_ones_may_be_all_there_is() -> None:
    """Those may all be 0; what float64 loses of their squares makes it no larger than that."""
    far, one = Range(np.full(2, -1e6), np.full(2, 1e6)), np.array([1.0, -1.0])
    found = geometry.normalize(Context(load_table("opencl"), CauseBook(), 2), (Range(one, one), far, far))
    assert found[0].cause is None
    assert 1.0 <= found[0].high[0] <= 1.0 + 2.0**-20 and -1.0 >= found[0].low[1] >= -1.0 - 2.0**-20


def test_exact_sums_hold_what_float64_loses() -> None:
    """In whatever order large terms vanish, and on whichever side of 0 they are."""
    large = 2.0**60
    terms = [
        (-large, 0.0),
        (0.0, large),
        (-large, -large),
        (large, large),
        (1.0, 1.0),
        (-1.0, -1.0),
        (-3.0, 5.0),
    ]
    for chosen in itertools.product(terms, repeat=3):
        low, high = geometry._exact_sum([(np.array([a]), np.array([b])) for a, b in chosen])
        exact = [sum(Fraction(term[e]) for term in chosen) for e in (0, 1)]
        assert Fraction(float(low[0])) <= exact[0] and exact[1] <= Fraction(float(high[0]))
        size = sum(max(abs(a), abs(b)) for a, b in chosen)
        assert exact[0] - Fraction(float(low[0])) <= Fraction(size) / 2**48
        assert Fraction(float(high[0])) - exact[1] <= Fraction(size) / 2**48


@pytest.mark.parametrize("formula", FORMULAS[4:6])
def test_components_are_cut_from_a_length_on(formula: str) -> None:
    """Components of 2^-62 and more have squares that do not vanish."""
    least = 2.0**-62
    zero = Range(np.zeros(LANES), np.zeros(LANES))
    for share, is_cut in ((0.9, False), (1.1, True), (0.99, False), (1.01, True)):
        low = float(np.float32(least * share))
        x = Range(np.full(LANES, low), np.full(LANES, 16.0 * low))
        with np.errstate(over="ignore"):
            (found, _) = geometry.normalize(context(with_formula(formula)), (x, zero))
        assert found.cause is None
        assert (found.high[0] == MOST) == is_cut and (found.high[0] > 2.0) != is_cut
