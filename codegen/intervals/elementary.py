"""Roots, exponentials, logarithms and trigonometry of float intervals, by the row of the table."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from codegen.intervals import bulk, numbers
from codegen.intervals.accuracy import Absolute, Inherited, Row, Ulp, Unstated
from codegen.intervals.arithmetic import checked, divide, outside, settle, settled_within_ulp, within_ulp
from codegen.intervals.causes import Codes, first
from codegen.intervals.context import Context
from codegen.intervals.numbers import Array
from codegen.intervals.values import Range

Monotone = Callable[[Array], Array]
_FUNCTIONS: dict[str, Monotone] = {"exp": np.exp, "exp2": np.exp2, "log": np.log, "log2": np.log2}
_PERIOD = 2.0 * math.pi
_LARGE = 1e9
"""Beyond it float64 cannot tell whether an interval holds an extreme of the sine."""


def square_root(context: Context, x: Range) -> Range:
    """sqrt(x) for x >= 0, anything where x may be negative.

    sqrt(0) is 0, although 1 / inverseSqrt(0) is unbounded: the square root is correctly rounded at 0 on every
    known driver, and without this convention no length of a vector that may vanish is bounded.
    """
    row = context.table.row("sqrt")
    codes = context.unbounded(x.cause, _fresh(x.low < 0.0, x.cause), "x", "x may be negative")
    if isinstance(row.accuracy, Inherited):
        rows = context.table.row("inverse_sqrt"), context.table.row("/")
        if (quick := bulk.square_root(context, x, *rows)) is not None and codes is None and not quick[2]:
            return Range(quick[0], quick[1])
        positive = Range(*_positive_part(x))
        found = divide(
            context,
            context.table.row("/"),
            _one(),
            inverse_root(context, positive, context.table.row("inverse_sqrt")),
        )
        low = np.where(x.low < numbers.SMALLEST, 0.0, found.low)
        high = np.where(x.high <= 0.0, 0.0, found.high)
        return settle(context, low, high, codes)
    assert isinstance(row.accuracy, Ulp)
    low, high = np.sqrt(np.maximum(x.low, 0.0)), np.sqrt(np.maximum(x.high, 0.0))
    high = low if x.is_point else high
    return settled_within_ulp(context, low, high, row.accuracy.ulps, row.accuracy.ulps, codes)


def _one() -> Range:
    one = np.ones(1)
    return Range(one, one)


def _positive_part(x: Range) -> tuple[Array, Array]:
    """Ends not below the smallest normal number."""
    low = np.maximum(x.low, numbers.SMALLEST)
    return (low, low) if x.is_point else (low, np.maximum(x.high, numbers.SMALLEST))


def inverse_square_root(context: Context, x: Range) -> Range:
    """1 / sqrt(x), anything where x may be 0 or less."""
    codes = context.unbounded(x.cause, _fresh(x.low <= 0.0, x.cause), "x", "x may be 0 or less")
    quick = bulk.inverse_square_root(context, x, context.table.row("inverse_sqrt"))
    if quick is not None:
        return checked(context, quick, codes)
    low, high = _positive_part(x)
    found = inverse_root(context, Range(low, high), context.table.row("inverse_sqrt"))
    return settle(context, found.low, found.high, codes)


def inverse_root(context: Context, x: Range, row: Row) -> Range:
    """1 / sqrt(x) for x > 0."""
    assert isinstance(row.accuracy, Ulp)
    high = 1.0 / np.sqrt(x.low)
    low = high if x.is_point else 1.0 / np.sqrt(x.high)
    return settled_within_ulp(context, low, high, row.accuracy.ulps, row.accuracy.ulps, None)


def exponential(context: Context, name: str, x: Range) -> Range:
    """exp or exp2."""
    row = context.table.row(name)
    if (bounded := _bounded(context, row, x)) is not None:
        return bounded
    function = _FUNCTIONS[name]
    low = function(x.low)
    high = low if x.is_point else function(x.high)
    assert isinstance(row.accuracy, Ulp)
    return settled_within_ulp(context, low, high, *_ulps(row.accuracy, x), x.cause)


def _ulps(promise: Ulp, x: Range) -> tuple[float | Array, float | Array]:
    """How many ULP at the ends of the argument; where only whole ones count, at the larger end for both."""
    if promise.whole:
        larger = promise.ulps + np.floor(promise.per_abs_x * np.maximum(np.abs(x.low), np.abs(x.high)))
        return larger, larger
    if not promise.per_abs_x:
        return promise.ulps, promise.ulps
    low, high = (promise.ulps + promise.per_abs_x * np.abs(end) for end in (x.low, x.high))
    return low, high


def logarithm(context: Context, name: str, x: Range) -> Range:
    """log or log2; anything where x may be 0 or less."""
    row = context.table.row(name)
    if (bounded := _bounded(context, row, x)) is not None:
        return bounded
    codes = context.unbounded(x.cause, _fresh(x.low <= 0.0, x.cause), "x", "x may be 0 or less")
    positive_low, positive_high = _positive_part(x)
    low = _FUNCTIONS[name](positive_low)
    high = low if x.is_point else _FUNCTIONS[name](positive_high)
    if isinstance(row.accuracy, Ulp):
        return settled_within_ulp(context, low, high, row.accuracy.ulps, row.accuracy.ulps, codes)
    assert isinstance(row.accuracy, Absolute)
    positive = Range(positive_low, positive_high)
    if (quick := bulk.absolute_or_ulp(context, row.accuracy, positive, low, high)) is not None:
        return checked(context, quick, codes)
    low, high = _absolute_or_ulp(row.accuracy, positive, low, high)
    return settle(context, low, high, codes)


def _absolute_or_ulp(promise: Absolute, x: Range, low: Array, high: Array) -> tuple[Array, Array]:
    """The absolute bound where x lies in its interval, ULP where outside, the wider where either may be."""
    near_low, near_high = _within_absolute(promise.bound, low, high)
    touches = (x.high >= promise.within[0]) & (x.low <= promise.within[1])
    contained = (x.low >= promise.within[0]) & (x.high <= promise.within[1])
    if promise.elsewhere is None or contained.all():
        return near_low, near_high
    far_low, far_high = within_ulp(low, high, promise.elsewhere.ulps, promise.elsewhere.ulps)
    either_low = numbers.select(touches, np.minimum(near_low, far_low), far_low)
    either_high = numbers.select(touches, np.maximum(near_high, far_high), far_high)
    return (
        numbers.select(contained, near_low, either_low),
        numbers.select(contained, near_high, either_high),
    )


def _within_absolute(bound: float | Array, low: Array, high: Array) -> tuple[Array, Array]:
    slack = numbers.FLOAT64_MARGIN
    return (
        numbers.up(low - np.abs(low) * slack - bound),
        numbers.down(high + np.abs(high) * slack + bound),
    )


def sine(context: Context, name: str, x: Range) -> Range:
    """sin or cos; anything outside the interval of the promise."""
    row = context.table.row(name)
    if (bounded := _bounded(context, row, x)) is not None:
        return bounded
    function = np.sin if name == "sin" else np.cos
    crest = math.pi / 2.0 if name == "sin" else 0.0
    p = function(x.low)
    low = high = p
    if not x.is_point:
        q = function(x.high)
        low = np.where(_holds(x, crest + math.pi), -1.0, np.minimum(p, q))
        high = np.where(_holds(x, crest), 1.0, np.maximum(p, q))
    if isinstance(row.accuracy, Ulp):
        return settled_within_ulp(context, low, high, row.accuracy.ulps, row.accuracy.ulps, x.cause)
    assert isinstance(row.accuracy, Absolute)
    first_x, last_x = row.accuracy.within
    bad = (x.low < first_x) | (x.high > last_x)
    codes = context.unbounded(x.cause, _fresh(bad, x.cause), "x", "x may lie outside the promised interval")
    low, high = _within_absolute(row.accuracy.bound, low, high)
    return settle(context, low, high, codes)


def _holds(x: Range, extreme: float) -> Array:
    """Whether an interval may hold `extreme` plus a multiple of the period."""
    slack = 1e-12 + np.abs(x.high) * 1e-15
    turns = np.floor((x.high + slack - extreme) / _PERIOD) - np.floor((x.low - slack - extreme) / _PERIOD)
    return np.asarray((turns != 0.0) | (np.abs(x.low) > _LARGE) | (np.abs(x.high) > _LARGE))


def arc_tangent(context: Context, y: Range, x: Range) -> Range:
    """atan2(y, x); on the negative x-axis either sign of pi, since the sign of a zero may be lost."""
    row = context.table.row("atan2")
    if isinstance(row.accuracy, Unstated):
        return _nothing(context, np.maximum(x.low, y.low), first(y.cause, x.cause))
    codes = first(y.cause, x.cause)
    crosses = (y.low <= 0.0) & (y.high >= 0.0)
    origin = crosses & (x.low <= 0.0) & (x.high >= 0.0)
    codes = context.unbounded(codes, _fresh(origin, codes), "y, x", "both may be 0")
    for operand, value in (("x", x), ("y", y)):
        bad = outside(row, operand, value)
        if bad is not None:
            codes = context.unbounded(codes, _fresh(bad, codes), operand, "outside the promised magnitudes")
    corners = [np.arctan2(b, a) for b in (y.low, y.high) for a in (x.low, x.high)]
    low = np.minimum(np.minimum(corners[0], corners[1]), np.minimum(corners[2], corners[3]))
    high = np.maximum(np.maximum(corners[0], corners[1]), np.maximum(corners[2], corners[3]))
    cut = crosses & (x.low < 0.0)
    low, high = np.where(cut, -math.pi, low), np.where(cut, math.pi, high)
    assert isinstance(row.accuracy, Ulp)
    return settled_within_ulp(context, low, high, row.accuracy.ulps, row.accuracy.ulps, codes)


def _bounded(context: Context, row: Row, x: Range) -> Range | None:
    """Anything at all where the row states nothing; None where it states something."""
    return _nothing(context, x.low, x.cause) if isinstance(row.accuracy, Unstated) else None


def _nothing(context: Context, like: Array, codes: Codes) -> Range:
    everywhere = np.ones(like.shape, np.bool_)
    codes = context.unbounded(codes, _fresh(everywhere, codes), "", "the specification promises nothing")
    return settle(context, np.zeros(like.shape), np.zeros(like.shape), codes)


def _fresh(where: Array, codes: Codes) -> Array:
    """The mask without lanes that have a cause already."""
    return where if codes is None else where & (codes == 0)
