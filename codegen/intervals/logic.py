"""Comparisons of intervals and roundings to integers: where lanes may fork."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from codegen.intervals import bulk
from codegen.intervals.arithmetic import anything, rounded, settle
from codegen.intervals.causes import Codes
from codegen.intervals.context import MOST_WAYS, Context
from codegen.intervals.numbers import Array
from codegen.intervals.values import Range, Truth, Whole

_OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "=="}
Number = Range | Whole


def compare(context: Context, op: str, a: Number, b: Number) -> Truth:
    """The truth of a comparison; undecided lanes fork, and the way taken narrows both operands."""
    if isinstance(a, Range) and isinstance(b, Range) and a.cause is None and b.cause is None:
        quick = bulk.compare(context, op, a, b)
    else:
        quick = None
    if quick is None:
        true, false = _may_hold(op, a, b), _may_hold(_OPPOSITE[op], a, b)
    else:
        true, false, some_undecided = quick
        if not some_undecided:
            context.decided()
            return Truth(true, false)
    undecided = true & false
    for codes in (a.cause, b.cause):
        if codes is not None:  # a value that may be anything, NaN included, tells nothing by its order
            true, false = true | (codes > 0), false | (codes > 0)
            undecided = undecided & (codes == 0)
    way = context.fork(undecided + np.int8(1))
    if way is None:
        return Truth(true, false)
    holds, fails = undecided & (way == 1), undecided & (way == 0)
    _narrow(op, a, b, holds)
    _narrow(_OPPOSITE[op], a, b, fails)
    return Truth(true & ~fails, false & ~holds)


def _may_hold(op: str, a: Number, b: Number) -> Array:
    match op:
        case "<":
            return np.asarray(a.low < b.high) & (a is not b)
        case "<=":
            return np.asarray(a.low <= b.high)
        case ">":
            return np.asarray(a.high > b.low) & (a is not b)
        case ">=":
            return np.asarray(a.high >= b.low)
        case "==":
            return np.asarray((a.low <= b.high) & (b.low <= a.high))
        case _:
            return np.asarray((a.low < a.high) | (b.low < b.high) | (a.low != b.low)) & (a is not b)


def _narrow(op: str, a: Number, b: Number, where: Array) -> None:
    """Cut both operands to what the comparison leaves of them, in the lanes of the mask."""
    if not where.any() or op == "!=":
        return
    a_low, a_high, b_low, b_high = a.low, a.high, b.low, b.high
    if op in ("<", "<=", "=="):
        _cut(a, where, None, b_high)
        _cut(b, where, a_low, None)
    if op in (">", ">=", "=="):
        _cut(a, where, b_low, None)
        _cut(b, where, None, a_high)


def _cut(x: Number, where: Array, least: Array | None, most: Array | None) -> None:
    low, high = x.low, x.high
    x.cut(
        low if least is None else np.where(where, np.maximum(low, least), low),
        high if most is None else np.where(where, np.minimum(high, most), high),
    )


def floor(context: Context, x: Range) -> Range:
    """floor(x); lanes that may reach several integers fork."""
    low = np.floor(x.low)
    if x.is_point:
        context.decided()
        return Range(low, low, x.cause)
    high = np.floor(x.high)
    if x.cause is None and (low == high).all():
        context.decided()
        return Range(low, low)
    low, high = _follow(context, x, low, high, lambda k: (k, k + 1.0))
    return Range(low, high, x.cause)


def to_integer(context: Context, x: Range, is_signed: bool) -> Whole:
    """Truncation; anything where the result may lie outside the type: targets differ there."""
    whole = Whole(np.zeros(1, np.int64), np.zeros(1, np.int64), is_signed)
    least, most = whole.limits
    low, high = np.trunc(x.low), np.trunc(x.high)
    over = ~((low >= least) & (high <= most))
    codes: Codes = context.unbounded(
        x.cause, over if x.cause is None else over & (x.cause == 0), "x", "outside the integers of the type"
    )
    if codes is None and (x.is_point or (low == high).all()):
        context.decided()
        exact = low.astype(np.int64)
        return Whole(exact, exact, is_signed)
    if codes is not None:
        low, high = np.where(over, least, low), np.where(over, most, high)
    low, high = _follow(
        context, x, low, high, lambda k: (np.where(k <= 0, k - 1.0, k), np.where(k >= 0, k + 1.0, k))
    )
    first = low.astype(np.int64)
    return Whole(first, first if (low == high).all() else high.astype(np.int64), is_signed, codes)


def _follow(
    context: Context, x: Range, low: Array, high: Array, source: Callable[[Array], tuple[Array, Array]]
) -> tuple[Array, Array]:
    """Results low ... high; in lanes that were told a way, that one, and x cut to what gives it."""
    with np.errstate(invalid="ignore"):
        ways = np.fmin(high - low + 1.0, MOST_WAYS + 1.0).astype(np.int8)
    if x.cause is not None:
        ways = np.where(x.cause > 0, 1, ways)
    way = context.fork(ways)
    if way is None:
        return low, high
    told = (way >= 0) & (ways > 1)
    chosen = low + np.maximum(way, 0)
    least, most = source(chosen)
    _cut(x, told, least, most)
    return np.where(told, chosen, low), np.where(told, chosen, high)


def to_float(context: Context, a: Whole) -> Range:
    """The conversion to f32, rounded where the integer has more than 24 bits."""
    low = a.low.astype(np.float64)
    high = low if a.is_point else a.high.astype(np.float64)
    if max(-a.low.min(initial=0), a.high.max(initial=0)) > 2**24:
        low, high = rounded(context, low, high)
    return Range(low, high) if a.cause is None else anything(low, high, a.cause)


def from_bits(context: Context, a: Whole) -> Range:
    """The float of some bits; anything where they may not be a finite number or differ in sign."""
    low, high = (v.astype(np.uint32).view(np.float32).astype(np.float64) for v in (a.low, a.high))
    bad = ~(np.isfinite(low) & np.isfinite(high)) | ((a.low >> 31) != (a.high >> 31))
    codes = context.unbounded(
        a.cause, bad if a.cause is None else bad & (a.cause == 0), "x", "the bits may be no finite number"
    )
    if a.is_point:
        return settle(context, low, low, codes)
    return settle(context, np.minimum(low, high), np.maximum(low, high), codes)
