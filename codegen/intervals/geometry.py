"""dot, cross, length and normalize of interval vectors, by the row of the table."""

from __future__ import annotations

from functools import reduce

import numpy as np

from codegen.intervals import bulk, numbers
from codegen.intervals.accuracy import Inherited, Scaled, Ulp
from codegen.intervals.arithmetic import (
    add,
    checked,
    divide,
    multiply,
    settle,
    settled_within_ulp,
    subtract,
)
from codegen.intervals.causes import Codes, first
from codegen.intervals.context import Context
from codegen.intervals.elementary import inverse_square_root, square_root
from codegen.intervals.numbers import Array
from codegen.intervals.products import exact_product
from codegen.intervals.values import Range

Ranges = tuple[Range, ...]
_EPSILON = 2.0**-23
_NOT_VANISHING = 2.0**-62
"""Components from here on have squares that do not vanish."""
_MOST = 1.0 + 16 * _EPSILON
"""The largest component of a normalised vector, with more than all its roundings."""


def dot(context: Context, a: Ranges, b: Ranges) -> Range:
    """Inner product; never negative for a vector with itself, in whatever order the squares are summed."""
    accuracy = context.table.row("dot").accuracy
    if isinstance(accuracy, Inherited):
        return sum_in_any_order(context, [multiply(context, x, y) for x, y in zip(a, b, strict=True)])
    assert isinstance(accuracy, Scaled)
    share = accuracy.epsilons + accuracy.per_component * len(a)
    if (found := bulk.scaled_dot(context, a, b, share, _EPSILON)) is not None:
        return checked(context, found, _causes((*a, *b)))
    low, high = _exact_sum([exact_product(x, y) for x, y in zip(a, b, strict=True)])
    slack = _scaled(accuracy, (*a, *b), len(a))
    low, high = numbers.up(low - slack), numbers.down(high + slack)
    if all(x is y for x, y in zip(a, b, strict=True)):
        low = np.maximum(low, 0.0)
    return settle(context, low, high, _causes((*a, *b)))


def sum_in_any_order(context: Context, terms: list[Range]) -> Range:
    """The hull of the sums of the terms over all orders and groupings."""
    if (quick := bulk.sum_of_three(context, terms)) is not None:
        return quick
    sums: dict[frozenset[int], Range] = {frozenset([k]): term for k, term in enumerate(terms)}

    def total(of: frozenset[int]) -> Range:
        if of not in sums:
            least, *rest = sorted(of)
            found = []
            for chosen in range(2 ** len(rest) - 1):
                part = frozenset([least, *(k for bit, k in enumerate(rest) if chosen >> bit & 1)])
                found.append(add(context, total(part), total(of - part)))
            sums[of] = reduce(_hull, found)
        return sums[of]

    return total(frozenset(range(len(terms))))


def _hull(a: Range, b: Range) -> Range:
    return Range(np.minimum(a.low, b.low), np.maximum(a.high, b.high), first(a.cause, b.cause))


def cross(context: Context, a: Ranges, b: Ranges) -> Ranges:
    """Outer product."""
    accuracy = context.table.row("cross").accuracy
    pairs = ((1, 2), (2, 0), (0, 1))
    if isinstance(accuracy, Inherited):
        return tuple(
            subtract(context, multiply(context, a[i], b[j]), multiply(context, a[j], b[i])) for i, j in pairs
        )
    assert isinstance(accuracy, Scaled)
    slack = _scaled(accuracy, (*a, *b), 3)
    codes = _causes((*a, *b))
    found = []
    for i, j in pairs:
        taken_low, taken_high = exact_product(a[j], b[i])
        low, high = _exact_sum([exact_product(a[i], b[j]), (-taken_high, -taken_low)])
        found.append(settle(context, numbers.up(low - slack), numbers.down(high + slack), codes))
    return tuple(found)


def length(context: Context, x: Ranges) -> Range:
    """Euclidean length."""
    accuracy = context.table.row("length").accuracy
    if isinstance(accuracy, Inherited):
        return square_root(context, dot(context, x, x))
    assert isinstance(accuracy, Ulp)
    near, far = _exact_sum([exact_product(c, c) for c in x])
    ulps = accuracy.ulps + accuracy.per_component * len(x)
    low, high = np.sqrt(np.maximum(near, 0.0)), np.sqrt(far)
    return settled_within_ulp(context, low, high, ulps, ulps, _causes(x))


def normalize(context: Context, x: Ranges) -> Ranges:
    """x over its length; anything where x may be 0."""
    accuracy = context.table.row("normalize").accuracy
    if isinstance(accuracy, Inherited):
        ways: list[Ranges] = []
        if "x / length(x)" in accuracy.formula:
            size = length(context, x)
            vanishing = size.low < _NOT_VANISHING
            shares = [divide(context, context.table.row("/"), c, size) for c in x]
            ways.append(tuple(_at_most_one(share, vanishing) for share in shares))
        if "inverse_sqrt" in accuracy.formula:
            factor = inverse_square_root(context, dot(context, x, x))
            vanishing = factor.high > 1.0 / _NOT_VANISHING
            shares = [multiply(context, c, factor) for c in x]
            ways.append(tuple(_at_most_one(share, vanishing) for share in shares))
        return tuple(reduce(_hull, forms) for forms in zip(*ways, strict=True))
    assert isinstance(accuracy, Ulp)
    ulps = accuracy.ulps + accuracy.per_component * len(x)
    codes = _causes(x)
    nearest = _exact_sum([exact_product(c, c) for c in x])[0]
    vanishes = nearest <= 0.0 if codes is None else (nearest <= 0.0) & (codes == 0)
    codes = context.unbounded(codes, vanishes, "x", "x may be the zero vector")
    return tuple(_normalized(context, k, x, ulps, codes) for k in range(len(x)))


def _at_most_one(share: Range, vanishing: Array) -> Range:
    """A component over the length, cut to what single vectors of the interval give: 1 and its roundings.

    The length of a vector has the square of this component among its terms, which are all positive; ten
    roundings at most lie between it and the quotient. Only a component whose square vanishes may exceed its
    share of the length, and only where the length itself may be as small: there nothing is cut.
    """
    if share.high.max(initial=0.0) <= _MOST and share.low.min(initial=0.0) >= -_MOST:
        return share
    kept = vanishing if share.cause is None else vanishing | (share.cause > 0)
    low = np.where(kept, share.low, np.maximum(share.low, -_MOST))
    return Range(low, np.where(kept, share.high, np.minimum(share.high, _MOST)), share.cause)


def _normalized(context: Context, k: int, x: Ranges, ulps: float, codes: Codes) -> Range:
    """One component: it grows with x[k], and its size falls with the size of the others."""
    near, far = _exact_sum([exact_product(c, c) for j, c in enumerate(x) if j != k])
    near = np.maximum(near, 0.0)

    def share(c: Array, rest: Array) -> Array:
        size = np.sqrt(c * c + rest)
        return np.asarray(c / np.where(size > 0.0, size, 1.0))

    low = share(x[k].low, np.where(x[k].low >= 0.0, far, near))
    high = share(x[k].high, np.where(x[k].high >= 0.0, near, far))
    return settled_within_ulp(context, low, high, ulps, ulps, codes)


def _exact_sum(terms: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Ends of the exact sum of intervals, widened by what float64 may lose."""
    low, high = terms[0]
    size = np.maximum(np.abs(low), np.abs(high))
    for below, above in terms[1:]:
        low, high = low + below, high + above
        size = size + np.maximum(np.abs(below), np.abs(above))
    slack = size * numbers.FLOAT64_MARGIN
    return low - slack, high + slack


def _scaled(accuracy: Scaled, components: Ranges, size: int) -> Array:
    """The absolute bound: a number of 2^-23 times the square of the largest magnitude of any component."""
    largest = reduce(np.maximum, [np.maximum(np.abs(c.low), np.abs(c.high)) for c in components])
    return np.asarray(largest * largest * (accuracy.epsilons + accuracy.per_component * size) * _EPSILON)


def _causes(components: Ranges) -> Codes:
    return first(*(c.cause for c in components))
