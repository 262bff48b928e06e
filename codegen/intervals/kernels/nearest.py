"""Arithmetic that rounds to nearest, fused or not, as OpenCL promises."""

from __future__ import annotations

from typing import Any

from codegen.intervals.lanes import (
    at,
    compiled,
    inlined,
    nearest,
    settled_high,
    settled_low,
    sum_down,
    sum_up,
)
from codegen.intervals.numbers import LARGEST, SMALLEST, Array

Ends = Any


@compiled
def multiply_nearest(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Array, high: Array) -> int:
    """a b, rounded to nearest."""
    look = 0
    for i in range(len(low)):
        u, v = _exact(at(a_low, i), at(a_high, i), at(b_low, i), at(b_high, i))
        x, y = settled_low(nearest(u)), settled_high(nearest(v))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def square_nearest(a_low: Ends, a_high: Ends, low: Array, high: Array) -> int:
    """a a, rounded to nearest."""
    look = 0
    for i in range(len(low)):
        u, v = _exact_square(at(a_low, i), at(a_high, i))
        x, y = settled_low(nearest(u)), settled_high(nearest(v))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def _exact(a_low: Any, a_high: Any, b_low: Any, b_high: Any) -> Any:
    p, q, r, s = a_low * b_low, a_high * b_low, a_low * b_high, a_high * b_high
    return min(min(p, q), min(r, s)), max(max(p, q), max(r, s))


@inlined
def _exact_square(low: Any, high: Any) -> Any:
    near, far = max(max(low, -high), 0.0), max(abs(low), abs(high))
    return near * near, far * far


@compiled
def multiply_points(a: Ends, b: Ends, near: Array) -> int:
    """Products of numbers, rounded to nearest; looked at below the normal numbers as well."""
    look = 0
    for i in range(len(near)):
        x = nearest(at(a, i) * at(b, i))
        near[i] = x
        look |= _unusual(x)
    return look


@compiled
def add_points(a: Ends, a_sign: float, b: Ends, b_sign: float, near: Array) -> int:
    """Sums of numbers times their signs, rounded to nearest; looked at below the normal numbers as well."""
    look = 0
    for i in range(len(near)):
        x = nearest(a_sign * at(a, i) + b_sign * at(b, i))
        near[i] = x
        look |= _unusual(x)
    return look


@inlined
def _unusual(x: Any) -> Any:
    return (not abs(x) <= LARGEST) | ((abs(x) < SMALLEST) & (x != 0.0))


@compiled
def add_nearest(
    a_first: Ends, a_last: Ends, a_sign: float, b_first: Ends, b_last: Ends, b_sign: float,
    low: Array, high: Array,
) -> int:  # fmt: skip
    """The sum of two values, rounded to nearest: ends that become the lower and the upper by their sign."""
    look = 0
    for i in range(len(low)):
        x = settled_low(nearest(a_sign * at(a_first, i) + b_sign * at(b_first, i)))
        y = settled_high(nearest(a_sign * at(a_last, i) + b_sign * at(b_last, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def _unrounded(p_low: Any, p_high: Any, q_low: Any, q_high: Any, is_square: bool, sign: float) -> Any:
    """Ends of the exact p q, times its sign."""
    u, v = _exact_square(p_low, p_high) if is_square else _exact(p_low, p_high, q_low, q_high)
    return (u, v) if sign > 0.0 else (-v, -u)


@compiled
def add_fused(
    a_first: Ends, a_last: Ends, a_sign: float,
    p_low: Ends, p_high: Ends, q_low: Ends, q_high: Ends, is_square: bool, pq_sign: float,
    b_first: Ends, b_last: Ends, b_sign: float, low: Array, high: Array,
) -> int:  # fmt: skip
    """a + b as add_nearest has it, or the exact p q, whose rounding is a, plus b."""
    look = 0
    for i in range(len(low)):
        least, most = _unrounded(
            at(p_low, i), at(p_high, i), at(q_low, i), at(q_high, i), is_square, pq_sign
        )  # fmt: skip
        b, c = b_sign * at(b_first, i), b_sign * at(b_last, i)
        p, q = nearest(a_sign * at(a_first, i) + b), nearest(a_sign * at(a_last, i) + c)
        x, y = settled_low(min(p, sum_down(least, b))), settled_high(max(q, sum_up(most, c)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def fuse(
    low: Array, high: Array,
    p_low: Ends, p_high: Ends, q_low: Ends, q_high: Ends, is_square: bool, pq_sign: float,
    a_first: Ends, a_last: Ends, a_sign: float,
) -> int:  # fmt: skip
    """Widen settled sums, in place, by those of an exact p q with a."""
    look = 0
    for i in range(len(low)):
        least, most = _unrounded(
            at(p_low, i), at(p_high, i), at(q_low, i), at(q_high, i), is_square, pq_sign
        )  # fmt: skip
        x = min(low[i], settled_low(sum_down(least, a_sign * at(a_first, i))))
        y = max(high[i], settled_high(sum_up(most, a_sign * at(a_last, i))))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look
