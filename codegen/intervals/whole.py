"""Integers: exact where operands are known, hulls of results where they are intervals; u32 wraps."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np

from codegen.intervals.causes import Codes, first
from codegen.intervals.numbers import Array
from codegen.intervals.values import Range, Whole

_MODULUS = 2**32
_WITHIN = ("&", "|", "^", ">>")
"""Operators whose exact result is in the type where the operands are."""
_MASKED = ("*", "<<")
"""Operators of whose exact result only the low 32 bits are kept."""
Ends = tuple[Array, Array]


def binary(op: str, a: Whole, b: Whole) -> Whole:
    """An operator on two integers."""
    if a.is_point and b.is_point:
        low = _exact(op, a.low, b.low)
        if op in _WITHIN or (op in _MASKED and not a.is_signed):
            return Whole(low, low, a.is_signed, first(a.cause, b.cause))
        high = low
    else:
        low, high = _HULLS[op](a, b)
        known = (a.low == a.high) & (b.low == b.high)
        if known.any():  # some lanes of an interval may be exact
            exact = _exact(op, a.low, b.low)
            low, high = np.where(known, exact, low), np.where(known, exact, high)
    return _wrapped(low, high, a, first(a.cause, b.cause))


def _exact(op: str, a: Array, b: Array) -> Array:
    """The operator on exact int64 operands, before wrapping."""
    match op:
        case "+":
            return np.asarray(a + b)
        case "-":
            return np.asarray(a - b)
        case "*":
            # Only the low 32 bits count, and int64 arithmetic keeps those of any product.
            return np.asarray((a * b) & (_MODULUS - 1))
        case "//":
            return np.asarray(a // np.where(b == 0, 1, b))
        case "%":
            return np.asarray(a % np.where(b == 0, 1, b))
        case "<<":
            return np.asarray((a << (b & 31)) & (_MODULUS - 1))
        case ">>":
            return np.asarray(a >> (b & 31))
        case "&":
            return np.asarray(a & b)
        case "|":
            return np.asarray(a | b)
        case _:
            return np.asarray(a ^ b)


def _sum(a: Whole, b: Whole) -> Ends:
    return a.low + b.low, a.high + b.high


def _difference(a: Whole, b: Whole) -> Ends:
    return a.low - b.high, a.high - b.low


def _product(a: Whole, b: Whole) -> Ends:
    # Exact in float64 up to 2^53; anything larger wraps anyway and counts as every integer.
    xs, ys = (
        [end.astype(np.float64) for end in ((v.low,) if v.is_point else (v.low, v.high))] for v in (a, b)
    )
    corners = [x * y for x in xs for y in ys]
    low, high = functools.reduce(np.minimum, corners), functools.reduce(np.maximum, corners)
    limit = 2.0**52
    lost = np.maximum(np.abs(low), np.abs(high)) > limit
    low, high = np.where(lost, -limit, low), np.where(lost, limit, high)
    return low.astype(np.int64), high.astype(np.int64)


def _quotient(a: Whole, b: Whole) -> Ends:
    least = np.maximum(b.low, 1)
    return a.low // np.maximum(b.high, 1), np.where(b.low < 1, np.maximum(a.high, 0), a.high // least)


def _every(a: Whole, b: Whole) -> Ends:
    shape = np.broadcast_shapes(a.low.shape, b.low.shape)
    return np.zeros(shape, np.int64), np.full(shape, _MODULUS - 1, np.int64)


def _shifted_down(a: Whole, b: Whole) -> Ends:
    safe = b.high <= 31
    return np.where(safe, a.low >> np.minimum(b.high, 31), 0), np.where(
        safe, a.high >> np.minimum(b.low, 31), a.high
    )


def _both_bits(a: Whole, b: Whole) -> Ends:
    high = np.minimum(a.high, b.high)
    return np.zeros(high.shape, np.int64), high


_HULLS: dict[str, Callable[[Whole, Whole], Ends]] = {
    "+": _sum,
    "-": _difference,
    "*": _product,
    "//": _quotient,
    "%": _every,
    "<<": _every,
    ">>": _shifted_down,
    "&": _both_bits,
    "|": _every,
    "^": _every,
}


def wrapped(a: Array, is_signed: bool) -> Array:
    """Integers as the type wraps them."""
    return np.asarray(((a + 2**31) & (_MODULUS - 1)) - 2**31 if is_signed else a & (_MODULUS - 1))


def _wrapped(low: Array, high: Array, like: Whole, codes: Codes) -> Whole:
    """Back into the type: ends that wrap alike stay an interval, others become every integer."""
    least, most = like.limits
    if low is high:
        a = wrapped(low, like.is_signed)
        return Whole(a, a, like.is_signed, codes)
    turns_low, turns_high = (low - least) >> 32, (high - least) >> 32
    same = turns_low == turns_high
    return Whole(
        np.where(same, low - (turns_low << 32), least),
        np.where(same, high - (turns_high << 32), most),
        like.is_signed,
        codes,
    )


def inverted(a: Whole) -> Whole:
    """Bitwise complement, which reverses the order."""
    low = _MODULUS - 1 - a.high
    return Whole(low, low if a.is_point else _MODULUS - 1 - a.low, a.is_signed, a.cause)


def negated(a: Whole) -> Whole:
    """-a; the smallest i32 wraps to itself."""
    low = -a.high
    return _wrapped(low, low if a.is_point else -a.low, a, a.cause)


def smaller(a: Whole, b: Whole) -> Whole:
    """min(a, b)."""
    low = np.minimum(a.low, b.low)
    point = a.is_point and b.is_point
    return Whole(low, low if point else np.minimum(a.high, b.high), a.is_signed, first(a.cause, b.cause))


def larger(a: Whole, b: Whole) -> Whole:
    """max(a, b)."""
    low = np.maximum(a.low, b.low)
    point = a.is_point and b.is_point
    return Whole(low, low if point else np.maximum(a.high, b.high), a.is_signed, first(a.cause, b.cause))


def float_to_bits(x: Range) -> Whole:
    """The bits of floats of one sign, which ascend with the magnitude; every word where it may differ."""
    low = np.ascontiguousarray(x.low.astype(np.float32)).view(np.uint32).astype(np.int64)
    high = (
        low
        if x.is_point
        else np.ascontiguousarray(x.high.astype(np.float32)).view(np.uint32).astype(np.int64)
    )
    positive, negative = x.low > 0.0, x.high < 0.0
    decided = positive | negative | ((x.low == x.high) & (x.low != 0.0))
    if x.is_point and decided.all() and x.cause is None:
        return Whole(low, low, False)
    least, most = np.where(negative, high, low), np.where(negative, low, high)
    # +0 and -0 are not told apart, so 0 may be either word.
    bounded = positive | negative
    if x.cause is not None:
        bounded = bounded & (x.cause == 0)
    return Whole(np.where(bounded, least, 0), np.where(bounded, most, _MODULUS - 1), False, x.cause)
