"""Quotients, roots, inner products and what is accurate within some ULP or absolutely, under every table."""

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
    settled_high,
    settled_low,
    up,
)
from codegen.intervals.numbers import FLOAT64_MARGIN, LARGEST, SMALLEST, Array

Ends = Any


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
    x_vanishes: bool,
    low: Array,
    high: Array,
) -> int:
    """x / y within some ULP; looked at where |y| may lie below `near` or above `far`, or |x| likewise.

    x_vanishes  whether x may be 0 all the same, if it is surely 0
    """
    look, anywhere = 0, not x_vanishes
    for i in range(len(low)):
        p, q, u, v = at(x_low, i), at(x_high, i), at(y_low, i), at(y_high, i)
        look |= (max(u, -v) < near) | (max(abs(u), abs(v)) > far)
        look |= (max(p, -q) < x_near) & (anywhere | (p != 0.0) | (q != 0.0))
        look |= max(abs(p), abs(q)) > x_far
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
