"""Interval operations as one loop over the lanes each, writing into arrays that are given.

Parts of compiled functions: of codegen.intervals.kernels, where each result is a fresh array, and of
codegen.intervals.machine, which runs whole programs block by block. What they compute is defined by
codegen.intervals.arithmetic and codegen.intervals.logic over numpy arrays, bit for bit. They are for tables
that flush.

An operand is an array (N,), or one number for all lanes; the last arguments are arrays (N,) for the results.
They return a flag: whether a lane needs a closer look, because it may overflow or lies outside what is
promised.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from codegen.intervals.lanes import (
    at,
    down,
    inlined,
    least_within,
    most_within,
    nearest,
    settled_high,
    settled_low,
    sum_down,
    sum_up,
    up,
)
from codegen.intervals.numbers import LARGEST, SMALLEST

Ends = Any


@inlined
def _inverse_root(low: Any, high: Any, ulps: Any) -> Any:
    near, far = 1.0 / np.sqrt(max(high, SMALLEST)), 1.0 / np.sqrt(max(low, SMALLEST))
    return settled_low(least_within(near, far, ulps)), settled_high(most_within(near, far, ulps))


@inlined
def _unusual(x: Any) -> Any:
    return (not abs(x) <= LARGEST) | ((abs(x) < SMALLEST) & (x != 0.0))


@inlined
def add(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Ends, high: Ends) -> Any:
    """a + b, rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        x = settled_low(sum_down(at(a_low, i), at(b_low, i)))
        y = settled_high(sum_up(at(a_high, i), at(b_high, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def subtract(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Ends, high: Ends) -> Any:
    """a - b, rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        x = settled_low(sum_down(at(a_low, i), -at(b_high, i)))
        y = settled_high(sum_up(at(a_high, i), -at(b_low, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def multiply(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Ends, high: Ends) -> Any:
    """a b, rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        p, q = at(a_low, i) * at(b_low, i), at(a_high, i) * at(b_low, i)
        r, s = at(a_low, i) * at(b_high, i), at(a_high, i) * at(b_high, i)
        x = settled_low(down(min(min(p, q), min(r, s))))
        y = settled_high(up(max(max(p, q), max(r, s))))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def square(a_low: Ends, a_high: Ends, low: Ends, high: Ends) -> Any:
    """a a, rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        p, q = at(a_low, i), at(a_high, i)
        near, far = max(max(p, -q), 0.0), max(abs(p), abs(q))
        x, y = settled_low(down(near * near)), settled_high(up(far * far))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def divide(
    x_low: Ends,
    x_high: Ends,
    y_low: Ends,
    y_high: Ends,
    ulps: float,
    near: float,
    far: float,
    low: Ends,
    high: Ends,
) -> Any:
    """x / y within some ULP; looked at where |y| may lie below `near` or above `far`."""
    look = 0
    for i in range(len(low)):
        p, q, u, v = at(x_low, i), at(x_high, i), at(y_low, i), at(y_high, i)
        look |= (max(u, -v) < near) | (max(abs(u), abs(v)) > far)
        negative = v < 0.0
        least, most = (-q if negative else p), (-p if negative else q)
        small, large = (-v if negative else u), (-u if negative else v)
        a, b = min(least / large, least / small), max(most / small, most / large)
        x, y = settled_low(least_within(a, b, ulps)), settled_high(most_within(a, b, ulps))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def inverse_square_root(x_low: Ends, x_high: Ends, ulps: float, low: Ends, high: Ends) -> Any:
    """1 / sqrt(x); looked at where x may be 0 or less."""
    look = 0
    for i in range(len(low)):
        p, q = at(x_low, i), at(x_high, i)
        x, y = _inverse_root(p, q, ulps)
        low[i], high[i] = x, y
        look |= (p <= 0.0) | (y > LARGEST)
    return look


@inlined
def square_root(
    x_low: Ends, x_high: Ends, ulps: float, ulps_divide: float, near: float, far: float, low: Ends, high: Ends
) -> Any:
    """1 / (1 / sqrt(x)), each within its ULP, 0 where x may be 0; looked at where x may be negative."""
    look = 0
    for i in range(len(low)):
        p, q = at(x_low, i), at(x_high, i)
        u, v = _inverse_root(p, q, ulps)
        least, most = 1.0 / v, 1.0 / u
        x, y = (
            settled_low(least_within(least, most, ulps_divide)),
            settled_high(most_within(least, most, ulps_divide)),
        )
        x, y = (0.0 if p < SMALLEST else x), (0.0 if q <= 0.0 else y)
        low[i], high[i] = x, y
        look |= (p < 0.0) | (u < near) | (v > far) | (y > LARGEST)
    return look


@inlined
def choose(
    true: Ends, false: Ends, a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Ends, high: Ends
) -> Any:
    """a where a condition holds, b where it does not, the hull where it may do either."""
    for i in range(len(low)):
        t, f = at(true, i), at(false, i)
        p, q, r, s = at(a_low, i), at(b_low, i), at(a_high, i), at(b_high, i)
        low[i] = min(p, q) if t & f else (p if t else q)
        high[i] = max(r, s) if t & f else (r if t else s)


@inlined
def multiply_nearest(
    a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, least: Ends, most: Ends, low: Ends, high: Ends
) -> Any:
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


@inlined
def multiply_points(a: Ends, b: Ends, exact: Ends, near: Ends) -> Any:
    """Exact products of numbers, and these rounded to nearest; looked at below the normal numbers as well."""
    look = 0
    for i in range(len(exact)):
        p = at(a, i) * at(b, i)
        x = nearest(p)
        exact[i], near[i] = p, x
        look |= _unusual(x)
    return look


@inlined
def add_points(a: Ends, b: Ends, near: Ends) -> Any:
    """Sums of numbers, rounded to nearest; looked at below the normal numbers as well."""
    look = 0
    for i in range(len(near)):
        x = nearest(at(a, i) + at(b, i))
        near[i] = x
        look |= _unusual(x)
    return look


@inlined
def add_nearest(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Ends, high: Ends) -> Any:
    """a + b, rounded to nearest."""
    look = 0
    for i in range(len(low)):
        x = settled_low(nearest(at(a_low, i) + at(b_low, i)))
        y = settled_high(nearest(at(a_high, i) + at(b_high, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def add_fused(
    a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, least: Ends, most: Ends, low: Ends, high: Ends
) -> Any:
    """a + b, rounded to nearest, or the exact product that is a, between `least` and `most`, plus b."""
    look = 0
    for i in range(len(low)):
        p, q = nearest(at(a_low, i) + at(b_low, i)), nearest(at(a_high, i) + at(b_high, i))
        x = settled_low(min(p, sum_down(at(least, i), at(b_low, i))))
        y = settled_high(max(q, sum_up(at(most, i), at(b_high, i))))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def less(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, true: Ends, false: Ends) -> Any:
    """Whether a < b may hold, whether it may fail, and whether both is so in a lane."""
    undecided = 0
    for i in range(len(true)):
        t, f = at(a_low, i) < at(b_high, i), at(a_high, i) >= at(b_low, i)
        true[i], false[i] = t, f
        undecided |= t & f
    return undecided


@inlined
def at_most(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, true: Ends, false: Ends) -> Any:
    """Whether a <= b may hold, whether it may fail, and whether both is so in a lane."""
    undecided = 0
    for i in range(len(true)):
        t, f = at(a_low, i) <= at(b_high, i), at(a_high, i) > at(b_low, i)
        true[i], false[i] = t, f
        undecided |= t & f
    return undecided


@inlined
def fuse(low: Ends, high: Ends, a_low: Ends, a_high: Ends, least: Ends, most: Ends) -> int:
    """Widen settled sums, in place, by those of an exact product with a."""
    look = 0
    for i in range(len(low)):
        x = min(low[i], settled_low(sum_down(at(least, i), at(a_low, i))))
        y = max(high[i], settled_high(sum_up(at(most, i), at(a_high, i))))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look
