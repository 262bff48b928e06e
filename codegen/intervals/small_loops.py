"""The quick interval operations as loops into given arrays: orderings, signs and truth.

numpy does these in a pass or two by itself; they are here for codegen.intervals.machine, which runs all
operations of a program block by block.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from codegen.intervals.lanes import inlined, nearest, settled_high, settled_low
from codegen.intervals.numbers import LARGEST

Ends = Any


@inlined
def smaller(a: Ends, b: Ends, found: Ends) -> None:
    """min(a, b), one end."""
    for i in range(len(found)):
        found[i] = min(a[i], b[i])


@inlined
def larger(a: Ends, b: Ends, found: Ends) -> None:
    """max(a, b), one end."""
    for i in range(len(found)):
        found[i] = max(a[i], b[i])


@inlined
def negate(a: Ends, found: Ends) -> None:
    """-a, one end."""
    for i in range(len(found)):
        found[i] = -a[i]


@inlined
def size(a: Ends, found: Ends) -> None:
    """|a| of a number."""
    for i in range(len(found)):
        found[i] = abs(a[i])


@inlined
def absolute(a_low: Ends, a_high: Ends, low: Ends, high: Ends) -> None:
    """|a|."""
    for i in range(len(low)):
        p, q = a_low[i], a_high[i]
        low[i], high[i] = max(max(p, -q), 0.0), max(-p, q)


@inlined
def floor_point(a: Ends, found: Ends) -> None:
    """floor(a) of a number."""
    for i in range(len(found)):
        found[i] = np.floor(a[i])


@inlined
def floor(
    a_low: Ends, a_high: Ends, low: Ends, high: Ends, most: Any, fork: Any, first: Ends, width: Ends
) -> None:
    """floor(a); a lane with several results forks, unless they are more than `most`."""
    several = False
    for i in range(len(low)):
        p, q = np.floor(a_low[i]), np.floor(a_high[i])
        low[i], high[i] = p, q
        several |= q > p
    if several:
        for i in range(len(low)):
            ways = high[i] - low[i]
            if ways > 0.0 and ways < most and first[i] < 0:
                first[i], width[i] = fork, np.int32(ways) + 1


@inlined
def clamp(
    x_low: Ends, x_high: Ends, a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, low: Ends, high: Ends
) -> None:
    """min(max(x, a), b); where a may exceed b also max(min(x, b), a)."""
    for i in range(len(low)):
        p, q = min(max(x_low[i], a_low[i]), b_low[i]), min(max(x_high[i], a_high[i]), b_high[i])
        r, s = max(min(x_low[i], b_low[i]), a_low[i]), max(min(x_high[i], b_high[i]), a_high[i])
        crossed = a_high[i] > b_low[i]
        low[i], high[i] = (min(p, r) if crossed else p), (max(q, s) if crossed else q)


@inlined
def equal(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, true: Ends, false: Ends) -> Any:
    """Whether a == b may hold, whether it may fail, and whether both is so in a lane."""
    undecided = 0
    for i in range(len(true)):
        t = (a_low[i] <= b_high[i]) & (b_low[i] <= a_high[i])
        f = (a_low[i] < a_high[i]) | (b_low[i] < b_high[i]) | (a_low[i] != b_low[i])
        true[i], false[i] = t, f
        undecided |= t & f
    return undecided


@inlined
def note(true: Ends, false: Ends, fork: Any, first: Ends, width: Ends) -> None:
    """Note a comparison as the first fork of lanes that it leaves open."""
    for i in range(len(true)):
        if true[i] & false[i] and first[i] < 0:
            first[i], width[i] = fork, 2


@inlined
def conjunction(a: Ends, b: Ends, found: Ends) -> None:
    """a and b."""
    for i in range(len(found)):
        found[i] = a[i] & b[i]


@inlined
def disjunction(a: Ends, b: Ends, found: Ends) -> None:
    """a or b."""
    for i in range(len(found)):
        found[i] = a[i] | b[i]


@inlined
def seen(true: Ends, false: Ends) -> Any:
    """Whether a condition may hold anywhere (1), and may fail anywhere (2)."""
    t = f = False
    for i in range(len(true)):
        t |= true[i]
        f |= false[i]
    return (1 if t else 0) | (2 if f else 0)


@inlined
def choose_point(true: Ends, false: Ends, a: Ends, b: Ends, found: Ends) -> Any:
    """a where a condition holds, else b; looked at where it is not decided."""
    look = 0
    for i in range(len(found)):
        found[i] = a[i] if true[i] else b[i]
        look |= true[i] & false[i]
    return look


@inlined
def square_nearest(a_low: Ends, a_high: Ends, least: Ends, most: Ends, low: Ends, high: Ends) -> Any:
    """Ends of the exact squares; and of a a, rounded to nearest."""
    look = 0
    for i in range(len(low)):
        near, far = max(max(a_low[i], -a_high[i]), 0.0), max(abs(a_low[i]), abs(a_high[i]))
        u, v = near * near, far * far
        x, y = settled_low(nearest(u)), settled_high(nearest(v))
        least[i], most[i], low[i], high[i] = u, v, x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look
