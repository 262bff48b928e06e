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
def multiply_nearest(
    a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, least: Array, most: Array, low: Array, high: Array
) -> int:
    """Ends of the exact products; and of a b, rounded to nearest."""
    look = 0
    for i in range(len(least)):
        p, q = at(a_low, i) * at(b_low, i), at(a_high, i) * at(b_low, i)
        r, s = at(a_low, i) * at(b_high, i), at(a_high, i) * at(b_high, i)
        u, v = min(min(p, q), min(r, s)), max(max(p, q), max(r, s))
        x, y = settled_low(nearest(u)), settled_high(nearest(v))
        least[i], most[i], low[i], high[i] = u, v, x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def square_nearest(a_low: Ends, a_high: Ends, least: Array, most: Array, low: Array, high: Array) -> int:
    """Ends of the exact squares; and of a a, rounded to nearest."""
    look = 0
    for i in range(len(least)):
        p, q = at(a_low, i), at(a_high, i)
        near, far = max(max(p, -q), 0.0), max(abs(p), abs(q))
        u, v = near * near, far * far
        x, y = settled_low(nearest(u)), settled_high(nearest(v))
        least[i], most[i], low[i], high[i] = u, v, x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def multiply_points(a: Ends, b: Ends, exact: Array, near: Array) -> int:
    """Exact products of numbers, and these rounded to nearest; looked at below the normal numbers as well."""
    look = 0
    for i in range(len(exact)):
        p = at(a, i) * at(b, i)
        x = nearest(p)
        exact[i], near[i] = p, x
        look |= _unusual(x)
    return look


@compiled
def add_points(a: Ends, b: Ends, near: Array) -> int:
    """Sums of numbers, rounded to nearest; looked at below the normal numbers as well."""
    look = 0
    for i in range(len(near)):
        x = nearest(at(a, i) + at(b, i))
        near[i] = x
        look |= _unusual(x)
    return look


@inlined
def _unusual(x: Any) -> Any:
    return (not abs(x) <= LARGEST) | ((abs(x) < SMALLEST) & (x != 0.0))


@compiled
def add_nearest(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Array, high: Array) -> int:
    """a + b, rounded to nearest."""
    look = 0
    for i in range(len(low)):
        x = settled_low(nearest(at(a_low, i) + at(b_low, i)))
        y = settled_high(nearest(at(a_high, i) + at(b_high, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def add_fused(
    a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, least: Ends, most: Ends, low: Array, high: Array
) -> int:
    """a + b, rounded to nearest, or the exact product that is a, between `least` and `most`, plus b."""
    look = 0
    for i in range(len(low)):
        p, q = nearest(at(a_low, i) + at(b_low, i)), nearest(at(a_high, i) + at(b_high, i))
        x = settled_low(min(p, sum_down(at(least, i), at(b_low, i))))
        y = settled_high(max(q, sum_up(at(most, i), at(b_high, i))))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def fuse(low: Array, high: Array, a_low: Ends, a_high: Ends, least: Ends, most: Ends) -> int:
    """Widen settled sums, in place, by those of an exact product with a."""
    look = 0
    for i in range(len(low)):
        x = min(low[i], settled_low(sum_down(at(least, i), at(a_low, i))))
        y = max(high[i], settled_high(sum_up(at(most, i), at(a_high, i))))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look
