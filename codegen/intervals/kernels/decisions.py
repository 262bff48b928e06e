"""Comparisons, the choice between two values, and ends of what is not known."""

from __future__ import annotations

import math
from typing import Any

from codegen.intervals.lanes import at, compiled
from codegen.intervals.numbers import LARGEST, Array

Ends = Any


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


@compiled
def unknown(a_low: Ends, a_high: Ends, codes: Any, low: Array, high: Array) -> int:
    """Ends that are infinite where there is a cause; looked at where they may overflow without one."""
    look = 0
    for i in range(len(low)):
        x, y, known = at(a_low, i), at(a_high, i), at(codes, i) == 0
        fits = (x >= -LARGEST) & (y <= LARGEST)
        low[i] = x if known & fits else -math.inf
        high[i] = y if known & fits else math.inf
        look |= known & (not fits)
    return look
