"""Arithmetic that rounds to either neighbour, as WGSL, Vulkan and OpenGL permit."""

from __future__ import annotations

from typing import Any

from codegen.intervals.lanes import (
    at,
    compiled,
    down,
    inlined,
    settled_high,
    settled_low,
    sum_down,
    sum_up,
    up,
)
from codegen.intervals.numbers import LARGEST, Array

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
