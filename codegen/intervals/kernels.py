"""The commonest interval operations as one loop over the lanes each, compiled by numba.

Imported only where numba is installed and there are lanes enough, see codegen.intervals.compiled. What they
compute is defined by codegen.intervals.arithmetic and codegen.intervals.logic over numpy arrays,
bit for bit; here nothing is written between the steps of an operation. They are for tables that flush.

An operand is an array (N,), or one number for all lanes. The last arrays take the results; what is returned
is a flag: whether a lane needs a closer look, because it may overflow or lies outside what is promised.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from codegen.intervals.lanes import (
    at,
    compiled,
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
from codegen.intervals.numbers import FLOAT64_MARGIN, LARGEST, SMALLEST, Array

Ends = Any


@compiled
def add(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Array, high: Array) -> int:
    """a + b, rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        x = settled_low(sum_down(at(a_low, i), at(b_low, i)))
        y = settled_high(sum_up(at(a_high, i), at(b_high, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def subtract(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Array, high: Array) -> int:
    """a - b, rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        x = settled_low(sum_down(at(a_low, i), -at(b_high, i)))
        y = settled_high(sum_up(at(a_high, i), -at(b_low, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def multiply(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Array, high: Array) -> int:
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


@compiled
def square(a_low: Ends, a_high: Ends, low: Array, high: Array) -> int:
    """a a, rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        p, q = at(a_low, i), at(a_high, i)
        near, far = max(max(p, -q), 0.0), max(abs(p), abs(q))
        x, y = settled_low(down(near * near)), settled_high(up(far * far))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def within_ulp(low: Ends, high: Ends, ulps_low: Ends, ulps_high: Ends, first: Array, last: Array) -> int:
    """Float32 within some ULP of numbers between two different ends."""
    look = 0
    for i in range(len(first)):
        x = settled_low(least_within(at(low, i), at(high, i), at(ulps_low, i)))
        y = settled_high(most_within(at(low, i), at(high, i), at(ulps_high, i)))
        first[i], last[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def absolute_or_ulp(
    x_low: Ends, x_high: Ends, low: Ends, high: Ends, bound: float, first: float, last: float, ulps: float,
    least: Array, most: Array,
) -> int:  # fmt: skip
    """Float32 within a bound where x lies from first to last, elsewhere within some ULP."""
    look = 0
    for i in range(len(least)):
        p, q, u, v = at(low, i), at(high, i), at(x_low, i), at(x_high, i)
        near_low = up(p - abs(p) * FLOAT64_MARGIN - bound)
        near_high = down(q + abs(q) * FLOAT64_MARGIN + bound)
        far_low, far_high = least_within(p, q, ulps), most_within(p, q, ulps)
        touches, contained = (v >= first) & (u <= last), (u >= first) & (v <= last)
        either_low = min(near_low, far_low) if touches else far_low
        either_high = max(near_high, far_high) if touches else far_high
        x = settled_low(near_low if contained else either_low)
        y = settled_high(near_high if contained else either_high)
        least[i], most[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@compiled
def divide(
    x_low: Ends,
    x_high: Ends,
    y_low: Ends,
    y_high: Ends,
    ulps: float,
    near: float,
    far: float,
    x_near: float,
    x_far: float,
    low: Array,
    high: Array,
) -> int:
    """x / y within some ULP; looked at where |y| may lie below `near` or above `far`, or |x| likewise."""
    look = 0
    for i in range(len(low)):
        p, q, u, v = at(x_low, i), at(x_high, i), at(y_low, i), at(y_high, i)
        look |= (max(u, -v) < near) | (max(abs(u), abs(v)) > far)
        look |= (max(p, -q) < x_near) | (max(abs(p), abs(q)) > x_far)
        negative = v < 0.0
        least, most = (-q if negative else p), (-p if negative else q)
        small, large = (-v if negative else u), (-u if negative else v)
        a, b = min(least / large, least / small), max(most / small, most / large)
        x, y = settled_low(least_within(a, b, ulps)), settled_high(most_within(a, b, ulps))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look


@inlined
def _inverse_root(low: Any, high: Any, ulps: Any) -> Any:
    near, far = 1.0 / np.sqrt(max(high, SMALLEST)), 1.0 / np.sqrt(max(low, SMALLEST))
    return settled_low(least_within(near, far, ulps)), settled_high(most_within(near, far, ulps))


@compiled
def inverse_square_root(x_low: Ends, x_high: Ends, ulps: float, low: Array, high: Array) -> int:
    """1 / sqrt(x); looked at where x may be 0 or less."""
    look = 0
    for i in range(len(low)):
        p, q = at(x_low, i), at(x_high, i)
        x, y = _inverse_root(p, q, ulps)
        low[i], high[i] = x, y
        look |= (p <= 0.0) | (y > LARGEST)
    return look


@compiled
def square_root(
    x_low: Ends,
    x_high: Ends,
    ulps: float,
    ulps_divide: float,
    near: float,
    far: float,
    low: Array,
    high: Array,
) -> int:
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
def _add(a_low: Any, a_high: Any, b_low: Any, b_high: Any) -> Any:
    return settled_low(sum_down(a_low, b_low)), settled_high(sum_up(a_high, b_high))


@compiled
def sum_of_three(
    a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, c_low: Ends, c_high: Ends, low: Array, high: Array
) -> int:
    """The hull of the sums of three terms over all groupings, each rounded to either neighbour."""
    look = 0
    for i in range(len(low)):
        a, b, c = at(a_low, i), at(b_low, i), at(c_low, i)
        p, q, r = at(a_high, i), at(b_high, i), at(c_high, i)
        bc, qr = _add(b, q, c, r)
        ac, pr = _add(a, p, c, r)
        ab, pq = _add(a, p, b, q)
        x1, y1 = _add(a, p, bc, qr)
        x2, y2 = _add(ab, pq, c, r)
        x3, y3 = _add(ac, pr, b, q)
        x, y = min(x1, min(x2, x3)), max(y1, max(y2, y3))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST) | (min(bc, min(ac, ab)) < -LARGEST)
        look |= max(qr, max(pr, pq)) > LARGEST
    return look


@inlined
def _product(a_low: Any, a_high: Any, b_low: Any, b_high: Any) -> Any:
    p, q, r, s = a_low * b_low, a_high * b_low, a_low * b_high, a_high * b_high
    return min(min(p, q), min(r, s)), max(max(p, q), max(r, s))


@inlined
def _square(a_low: Any, a_high: Any) -> Any:
    near, far = max(max(a_low, -a_high), 0.0), max(abs(a_low), abs(a_high))
    return near * near, far * far


@inlined
def _size(low: Any, high: Any) -> Any:
    return max(abs(low), abs(high))


@compiled
def scaled_dot(
    x: Ends, x_: Ends, y: Ends, y_: Ends, z: Ends, z_: Ends, u: Ends, u_: Ends, v: Ends, v_: Ends,
    w: Ends, w_: Ends, squared: bool, share: float, epsilon: float, low: Array, high: Array,
) -> int:  # fmt: skip
    """(x, y, z) . (u, v, w), upper ends x_ ..., off by at most `share` `epsilon` times the largest square."""
    look = 0
    for i in range(len(low)):
        if squared:
            (p, q), (r, s), (f, g) = _square(x[i], x_[i]), _square(y[i], y_[i]), _square(z[i], z_[i])
        else:
            p, q = _product(x[i], x_[i], u[i], u_[i])
            r, s = _product(y[i], y_[i], v[i], v_[i])
            f, g = _product(z[i], z_[i], w[i], w_[i])
        slack = (_size(p, q) + _size(r, s) + _size(f, g)) * FLOAT64_MARGIN
        largest = max(max(_size(x[i], x_[i]), _size(y[i], y_[i])), _size(z[i], z_[i]))
        others = max(max(_size(u[i], u_[i]), _size(v[i], v_[i])), _size(w[i], w_[i]))
        largest = max(largest, others)
        off = largest * largest * share * epsilon
        least, most = up((p + r + f) - slack - off), down((q + s + g) + slack + off)
        least = settled_low(max(least, 0.0) if squared else least)
        low[i], high[i] = least, settled_high(most)
        look |= (least < -LARGEST) | (high[i] > LARGEST)
    return look


@compiled
def choose(
    true: Ends, false: Ends, a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Array, high: Array
) -> None:
    """a where a condition holds, b where it does not, the hull where it may do either."""
    for i in range(len(low)):
        t, f = at(true, i), at(false, i)
        p, q, r, s = at(a_low, i), at(b_low, i), at(a_high, i), at(b_high, i)
        low[i] = min(p, q) if t & f else (p if t else q)
        high[i] = max(r, s) if t & f else (r if t else s)


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


@compiled
def less(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, true: Array, false: Array) -> int:
    """Whether a < b may hold, whether it may fail, and whether both is so in a lane."""
    undecided = 0
    for i in range(len(true)):
        t, f = at(a_low, i) < at(b_high, i), at(a_high, i) >= at(b_low, i)
        true[i], false[i] = t, f
        undecided |= t & f
    return undecided


@compiled
def at_most(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, true: Array, false: Array) -> int:
    """Whether a <= b may hold, whether it may fail, and whether both is so in a lane."""
    undecided = 0
    for i in range(len(true)):
        t, f = at(a_low, i) <= at(b_high, i), at(a_high, i) > at(b_low, i)
        true[i], false[i] = t, f
        undecided |= t & f
    return undecided


@compiled
def equal(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, true: Array, false: Array) -> int:
    """Whether a = b may hold, whether it may fail, and whether both is so in a lane."""
    undecided = 0
    for i in range(len(true)):
        p, q, r, s = at(a_low, i), at(a_high, i), at(b_low, i), at(b_high, i)
        t, f = (p <= s) & (r <= q), (p < q) | (r < s) | (p != r)
        true[i], false[i] = t, f
        undecided |= t & f
    return undecided
