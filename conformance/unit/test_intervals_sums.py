"""Sums, differences, products and quotients of intervals have the ends that fractions give.

Plan. Intervals, points and mixtures of both, shared ones among them, far apart in size, under tables that
round to either side, to nearest, and to nearest without multiply-adds.
  ends      each exact end rounded as the table says; a square is not negative; points stay one known number
            where one result is permitted
  products  the unrounded product is kept where a multiply-add may use it, and widens the sum by what one
            rounding may give, on whichever side of the sum it stands
  limits    where a row promises nothing of an operand, and what is told of it
"""

from __future__ import annotations

import itertools
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from codegen.intervals import arithmetic, load_table, numbers
from codegen.intervals.accuracy import Row, Ulp
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.products import unrounded
from codegen.intervals.tables import Table
from codegen.intervals.values import Product, Range

SEED = 20_268
LANES = 6
TABLES = {
    "either": load_table("wgsl"),
    "nearest": load_table("opencl"),
    "apart": replace(load_table("opencl"), fused=False),
}
Ends = tuple[Fraction, Fraction]
KINDS = ("interval", "point", "shared", "shared point", "positive", "negative")


def context(table: Table) -> Context:
    return Context(table, CauseBook(), LANES)


def single(rng: np.random.Generator, count: int, spread: int) -> Any:
    found = rng.uniform(1.0, 2.0, count) * 2.0 ** rng.integers(-spread, spread + 1, count)
    return (found * rng.choice([-1.0, 1.0], count)).astype(np.float32).astype(np.float64)


def operand(rng: np.random.Generator, kind: str, spread: int) -> Range:
    count = 1 if "shared" in kind else LANES
    p, q = single(rng, count, spread), single(rng, count, spread)
    if kind in ("positive", "negative"):
        p, q = (np.abs(x) if kind == "positive" else -np.abs(x) for x in (p, q))
    if "point" in kind:
        return Range(p, p)
    return Range(np.minimum(p, q), np.maximum(p, q))


def box(x: Range, lane: int) -> Ends:
    k = lane if len(x.low) > 1 else 0
    return Fraction(float(x.low[k])), Fraction(float(x.high[k]))


def beside(exact: Fraction, up: bool) -> Fraction:
    near = np.float32(float(exact))
    if Fraction(float(near)) != exact and (Fraction(float(near)) < exact) == up:
        near = np.nextafter(near, np.float32(np.inf if up else -np.inf))
    return Fraction(float(near))


def nearest(exact: Fraction) -> Fraction:
    """Ties to even: float(exact) might round twice, so that both neighbours are compared."""
    low, high = beside(exact, False), beside(exact, True)
    if exact - low == high - exact:
        return low if int(np.float32(float(low)).view(np.uint32)) % 2 == 0 else high
    return low if exact - low < high - exact else high


def rounded(table: Table, ends: Ends) -> Ends:
    if table.rounding == "nearest":
        return nearest(ends[0]), nearest(ends[1])
    return beside(ends[0], False), beside(ends[1], True)


def exact(op: str, a: Ends, b: Ends, alike: bool = False) -> Ends:
    match op:
        case "+":
            return a[0] + b[0], a[1] + b[1]
        case "-":
            return a[0] - b[1], a[1] - b[0]
        case _:
            corners = [x * y for x in a for y in b]
            if alike:
                return (Fraction(0) if a[0] < 0 < a[1] else min(a[0] ** 2, a[1] ** 2)), max(corners)
            return min(corners), max(corners)


OPERATORS = {"+": arithmetic.add, "-": arithmetic.subtract, "*": arithmetic.multiply}


def assert_ends(found: Range, expected: list[Ends]) -> None:
    for lane, ends in enumerate(expected):
        assert box(found, lane) == ends, lane


@pytest.mark.parametrize("spread", [3, 40])
@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("op", OPERATORS)
def test_ends_of_an_operator(op: str, name: str, spread: int) -> None:
    rng, table = np.random.default_rng(SEED + spread), TABLES[name]
    for kinds in itertools.product(KINDS, KINDS):
        a, b = (operand(rng, kind, spread) for kind in kinds)
        found = OPERATORS[op](context(table), a, b)
        lanes = range(max(len(a.low), len(b.low)))
        exactly = [exact(op, box(a, k), box(b, k)) for k in lanes]
        assert_ends(found, [rounded(table, ends) for ends in exactly])
        assert found.is_point == (table.rounding == "nearest" and a.is_point and b.is_point)
        assert found.cause is None and found.reach == numbers.reach(found.low, found.high)
        if op == "*" and name == "nearest":
            assert found.product is not None
            for end, of in zip(unrounded(found.product), zip(*exactly, strict=True), strict=True):
                assert [Fraction(float(x)) for x in end] == list(of)
        else:
            assert found.product is None


@pytest.mark.parametrize("name", TABLES)
def test_one_value_with_itself(name: str) -> None:
    rng, table = np.random.default_rng(SEED), TABLES[name]
    for kind in KINDS:
        x = operand(rng, kind, 20)
        square = arithmetic.multiply(context(table), x, x)
        boxes = [box(x, k) for k in range(len(x.low))]
        assert_ends(square, [rounded(table, exact("*", b, b, alike=True)) for b in boxes])
        nothing = arithmetic.subtract(context(table), x, x)
        assert nothing.is_point and nothing.low.tolist() == [0.0] and nothing.cause is None
    unknown = Range(np.full(2, -np.inf), np.full(2, np.inf), np.array([3, 3], np.int16))
    with np.errstate(invalid="ignore"):
        found = arithmetic.subtract(context(table), unknown, unknown)
    assert found.cause is not None and found.cause.tolist() == [3, 3]


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("where", ["first", "second", "both", "taken"])
def test_multiply_add_has_one_rounding_or_two(where: str, name: str) -> None:
    rng, table = np.random.default_rng(SEED), TABLES[name]
    for kinds in itertools.product(KINDS[:3], repeat=3):
        p, q, c = (operand(rng, kind, 3) for kind in kinds)
        here = context(table)
        product, other = arithmetic.multiply(here, p, q), arithmetic.multiply(here, q, c)
        parts = {
            "first": (product, c),
            "second": (c, product),
            "both": (product, other),
            "taken": (c, product),
        }[where]
        found = (arithmetic.subtract if where == "taken" else arithmetic.add)(here, *parts)
        sign = "-" if where == "taken" else "+"
        for k in range(max(len(part.low) for part in (p, q, c))):
            x, y = (box(part, k) for part in parts)
            ways = [rounded(table, exact(sign, x, y))]
            if name == "nearest":  # outwards, since either rounding of the fused sum counts
                unrounded = exact("*", box(p, k), box(q, k))
                ends = exact(sign, *((unrounded, y) if where in ("first", "both") else (x, unrounded)))
                ways.append((beside(ends[0], False), beside(ends[1], True)))
                if where == "both":
                    ends = exact("+", x, exact("*", box(q, k), box(c, k)))
                    ways.append((beside(ends[0], False), beside(ends[1], True)))
            assert box(found, k) == (min(w[0] for w in ways), max(w[1] for w in ways))


def row(accuracy: Ulp, **limits: Any) -> Row:
    return Row(accuracy, "c", **limits)


def quotient(
    promise: Row, x: list[tuple[float, float]], y: list[tuple[float, float]], flush: bool = True
) -> tuple[Range, list[str]]:
    here = Context(replace(TABLES["either"], flush=flush), CauseBook(), len(x))
    a, b = (
        Range(np.array([side[0] for side in sides]), np.array([side[1] for side in sides]))
        for sides in (x, y)
    )
    with np.errstate(all="ignore"):
        found = arithmetic.divide(here, promise, a, b)
    codes = [0] * len(x) if found.cause is None else found.cause.tolist()
    told = here.book.causes
    return found, [f"{told[c - 1].operand}: {told[c - 1].reason}" if c else "" for c in codes]


OUT = "outside the promised magnitudes"
ONE, TWO = (1.0, 1.0), (2.0, 2.0)


def test_magnitudes_of_a_divisor() -> None:
    """Both limits belong to the promise; 0 is told before them."""
    promise = row(Ulp(1.0), magnitude={"y": (-2, 3)})
    y = [
        (0.25, 8.0),
        (0.2, 1.0),
        (1.0, 8.5),
        (-8.0, -0.25),
        (-8.5, -1.0),
        (-1.0, -0.2),
        (0.0, 1.0),
        (-1.0, 1.0),
    ]
    _, told = quotient(promise, [TWO] * len(y), y)
    none = "y: the divisor may be 0"
    assert told == ["", f"y: {OUT}", f"y: {OUT}", "", f"y: {OUT}", f"y: {OUT}", none, none]


def test_magnitudes_of_a_dividend() -> None:
    """Which may be 0 itself where the row says so, and whose divisor counts first."""
    x = [(0.5, 4.0), (0.4, 1.0), (1.0, 5.0), (0.0, 0.0), (0.0, 1.0), (-4.0, -0.5), (-1.0, 1.0)]
    for zero in ((), ("x",)):
        promise = row(Ulp(1.0), magnitude={"x": (-1, 2), "y": (0, 1)}, zero=zero)
        _, told = quotient(promise, x, [TWO] * len(x))
        bad = f"x: {OUT}"
        assert told == ["", bad, bad, "" if zero else bad, bad, "", bad]
        _, told = quotient(promise, x[:2], [(4.0, 4.0), (4.0, 4.0)])
        assert told == [f"y: {OUT}"] * 2


def test_reciprocals_have_limits_of_their_own() -> None:
    """Where the dividend is 1, and nothing else."""
    promise = row(Ulp(1.0), magnitude={"x": (2, 5), "y": (2, 5)}, reciprocal=(-4, 4))
    y = [(8.0, 8.0), (0.0625, 16.0), (0.05, 1.0), (1.0, 17.0)]
    assert quotient(promise, [ONE] * 4, y)[1] == ["", "", f"y: {OUT}", f"y: {OUT}"]
    assert quotient(promise, [(1.0, 4.0), (8.0, 8.0), (8.0, 8.0)], [(8.0, 8.0), (8.0, 8.0), ONE])[1] == [
        f"x: {OUT}",
        "",
        f"y: {OUT}",
    ]


def test_operands_that_have_to_be_normal() -> None:
    smallest = float(np.finfo(np.float32).tiny)
    for limits in ({}, {"x": (-130, 10)}):
        promise = row(Ulp(1.0), normal=("x",), magnitude=limits)
        x = [
            (1.0, 2.0),
            (smallest, 1.0),
            (smallest / 2.0, 1.0),
            (-1.0, -smallest),
            (-1.0, 0.0),
            (1.0, 2000.0),
        ]
        expected = [False, False, True, False, True, bool(limits)]
        assert [bool(t) for t in quotient(promise, x, [TWO] * len(x))[1]] == expected


def test_ends_of_a_quotient() -> None:
    """The sign is that of the operands', and 0 over anything is 0."""
    boxes = [(1.0, 3.0), (-3.0, -1.0), (-1.0, 3.0), (0.0, 0.0), (0.0, 3.0), (-3.0, 0.0), (3.0, 3.0)]
    divisors = [(0.5, 7.0), (-7.0, -0.5), (3.0, 3.0), (-3.0, -3.0)]
    lanes = list(itertools.product(boxes, divisors))
    found, told = quotient(row(Ulp(2.0)), [a for a, _ in lanes], [b for _, b in lanes])
    assert not any(told)
    for k, (a, b) in enumerate(lanes):
        corners = [x / y for x in a for y in b]
        low, high = arithmetic.within_ulp(np.array([min(corners)]), np.array([max(corners)]), 2.0, 2.0)
        assert (found.low[k], found.high[k]) == (low[0], high[0])


@pytest.mark.parametrize("shared", [0, 1, 2, 3])
def test_quotients_of_points(shared: int) -> None:
    x, y = (
        np.array([1.0, -5.0, 7.0, 0.0]),
        np.array([3.0, 3.0, -0.7, 9.0]).astype(np.float32).astype(np.float64),
    )
    if shared & 1:
        x = x[:1]
    if shared & 2:
        y = y[2:3]
    here = Context(TABLES["either"], CauseBook(), 4)
    found = arithmetic.divide(here, row(Ulp(2.5)), Range(x, x), Range(y, y))
    low, high = arithmetic.within_ulp(q := x / y, q, 2.5, 2.5)
    assert np.array_equal(found.low, low) and np.array_equal(found.high, high)
    wide = arithmetic.divide(here, row(Ulp(2.5)), Range(x, x), Range(y, y.copy()))
    assert np.array_equal(wide.low, low) and np.array_equal(wide.high, high)


def test_clamps_absolute_values_and_orders_of_points_stay_points() -> None:
    x, y = np.array([-3.0, 2.0]), np.array([1.0, 1.5])
    a, b = Range(x, x), Range(y, y)
    assert arithmetic.absolute(a).is_point and arithmetic.absolute(a).low.tolist() == [3.0, 2.0]
    for made, expected in ((arithmetic.smaller(a, b), [-3.0, 1.5]), (arithmetic.larger(a, b), [1.0, 2.0])):
        assert made.is_point and made.low.tolist() == expected
    wide = Range(y, y + 1.0)
    for pair in ((a, wide), (wide, a)):
        small, large = arithmetic.smaller(*pair), arithmetic.larger(*pair)
        assert (small.low.tolist(), small.high.tolist()) == ([-3.0, 1.5], [-3.0, 2.0])
        assert (large.low.tolist(), large.high.tolist()) == ([1.0, 2.0], [2.0, 2.5])
    boxes = Range(np.array([-3.0, -3.0, 1.0, 0.0]), np.array([-1.0, 2.0, 2.0, 5.0]))
    found = arithmetic.absolute(boxes)
    assert (found.low.tolist(), found.high.tolist()) == ([1.0, 0.0, 1.0, 0.0], [3.0, 3.0, 2.0, 5.0])


def test_ends_that_are_settled_already() -> None:
    here = context(TABLES["either"])
    x = np.array([1.0, 2.0])
    assert not arithmetic.bounded(here, x, x.copy(), None).is_point
    assert arithmetic.bounded(here, x, x.copy(), None, same=True).is_point
    apart = arithmetic.bounded(here, x, x + np.array([0.0, 1.0]), None, same=True)
    assert not apart.is_point and apart.high.tolist() == [1.0, 3.0]
    product = Product((x, x + 1.0), (x, x))
    kept = arithmetic.bounded(here, x, x, None, product)
    assert kept.product is product and kept.cause is None
    codes = np.array([0, 4], np.int16)
    told = arithmetic.bounded(here, x, np.array([1.0, np.inf]), codes, product)
    assert told.cause is not None and told.cause.tolist() == [0, 4] and told.product is product
    assert here.book.causes == []
    ordinary = arithmetic.settle(here, x, x + 1.0)
    assert ordinary.product is None and ordinary.known == (1.0, 3.0, 1.0)
    given = arithmetic.from_input(here, np.array([1.0, -2.0], np.float32))
    assert given.product is None and given.known == (-2.0, 1.0, 1.0)
    smallest = float(np.finfo(np.float32).tiny)
    read = arithmetic.from_input(here, np.array([smallest, -smallest, -5.0, 5.0, 0.0, 1e-40], np.float32))
    assert read.low.tolist() == [smallest, -smallest, -5.0, 5.0, 0.0, 0.0]
    assert read.high[:5].tolist() == [smallest, -smallest, -5.0, 5.0, 0.0] and read.high[5] > 0.0
