"""The commonest interval operations as one loop over the lanes each, compiled by numba.

Imported only where numba is installed and there are lanes enough, see codegen.intervals.compiled. What they
compute is defined by codegen.intervals.arithmetic and codegen.intervals.logic over numpy arrays,
bit for bit; here nothing is written between the steps of an operation. They are for tables that flush.

An operand is an array (N,), or one number for all lanes. Results are fresh arrays and a flag: whether a lane
needs a closer look, because it may overflow or lies outside what is promised.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.extending import overload

from codegen.intervals.numbers import FLOAT64_MARGIN, LARGEST, PER_ULP, SMALLEST

Ends = Any
F = TypeVar("F", bound=Callable[..., Any])

_STEP = 1 << 29
_KEPT = ~(_STEP - 1)
_EXPONENT = 0x7FF << 52
_SMALLEST_BITS = int(np.float64(SMALLEST).view(np.int64))
_FAR = 2.0**1000


def compiled(function: F) -> F:
    """Compiled at its first call with some kinds of operands, and kept on disk."""
    return cast(F, numba.njit(nogil=True, cache=True, error_model="numpy")(function))


def inlined(function: F) -> F:
    """Part of compiled functions."""
    return cast(F, numba.njit(error_model="numpy")(function))


def at(x: Any, i: int) -> Any:
    """The number of a lane."""
    return x[i]


@overload(at)
def _at(x: Any, i: Any) -> Any:
    def of_lanes(x: Any, i: Any) -> Any:
        return x[i]

    def of_all(x: Any, i: Any) -> Any:
        return x

    return of_lanes if isinstance(x, numba.types.Array) else of_all


@inlined
def _bits(x: Any) -> Any:
    return np.float64(x).view(np.int64)


@inlined
def _float(x: Any) -> Any:
    return np.int64(x).view(np.float64)


@inlined
def _down(x: Any) -> Any:
    """The largest float32 at or below x."""
    b = _bits(x)
    return _float((b + ((b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def _up(x: Any) -> Any:
    """The smallest float32 at or above x."""
    b = _bits(x)
    return _float((b + (~(b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def _nearest(x: Any) -> Any:
    """The float32 nearest to x."""
    return np.float64(np.float32(x))


@inlined
def _lost(x: Any, y: Any, total: Any) -> Any:
    """What float64 lost in a sum (Knuth's two-sum)."""
    share = total - x
    return (x - (total - share)) + (y - share)


@inlined
def _sum_down(x: Any, y: Any) -> Any:
    total = x + y
    b = _bits(total)
    b -= (1 | (b >> 63)) if _lost(x, y, total) < 0.0 else 0  # the float64 below
    return _float((b + ((b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def _sum_up(x: Any, y: Any) -> Any:
    total = x + y
    b = _bits(total)
    b += (1 | (b >> 63)) if _lost(x, y, total) > 0.0 else 0  # the float64 above
    return _float((b + (~(b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def _settled_low(x: Any) -> Any:
    """A lower end that may flush."""
    flushed = 0.0 if x >= 0.0 else -SMALLEST
    return flushed if abs(x) < SMALLEST else x


@inlined
def _settled_high(x: Any) -> Any:
    """An upper end that may flush."""
    flushed = 0.0 if x <= 0.0 else SMALLEST
    return flushed if abs(x) < SMALLEST else x


@compiled
def add(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, count: int) -> Any:
    """a + b, rounded to either neighbour."""
    low, high, look = np.empty(count), np.empty(count), 0
    for i in range(count):
        x = _settled_low(_sum_down(at(a_low, i), at(b_low, i)))
        y = _settled_high(_sum_up(at(a_high, i), at(b_high, i)))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return low, high, look


@compiled
def multiply(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, count: int) -> Any:
    """a b, rounded to either neighbour."""
    low, high, look = np.empty(count), np.empty(count), 0
    for i in range(count):
        p, q = at(a_low, i) * at(b_low, i), at(a_high, i) * at(b_low, i)
        r, s = at(a_low, i) * at(b_high, i), at(a_high, i) * at(b_high, i)
        x = _settled_low(_down(min(min(p, q), min(r, s))))
        y = _settled_high(_up(max(max(p, q), max(r, s))))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return low, high, look


@compiled
def square(a_low: Ends, a_high: Ends, count: int) -> Any:
    """a a, rounded to either neighbour."""
    low, high, look = np.empty(count), np.empty(count), 0
    for i in range(count):
        p, q = at(a_low, i), at(a_high, i)
        near, far = max(max(p, -q), 0.0), max(abs(p), abs(q))
        x, y = _settled_low(_down(near * near)), _settled_high(_up(far * far))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return low, high, look


@inlined
def _ulp(x: Any) -> Any:
    """The distance of the float32 around x, with what is granted on varying numbers of ULP."""
    return _float(max(_bits(x) & _EXPONENT, _SMALLEST_BITS)) * 2.0**-23 * PER_ULP


@inlined
def _least(low: Any, high: Any, ulps: Any) -> Any:
    """The least float32 within some ULP of numbers between two ends, its sign kept."""
    least, most = low - abs(low) * FLOAT64_MARGIN, high + abs(high) * FLOAT64_MARGIN
    spacing = _ulp(least)
    inside = min(least + spacing * ulps, most)
    found = least - max(spacing, _ulp(inside)) * ulps
    return _up(max(found, min(low, 0.0) * _FAR))


@inlined
def _most(low: Any, high: Any, ulps: Any) -> Any:
    """The greatest float32 within some ULP of numbers between two ends, its sign kept."""
    least, most = low - abs(low) * FLOAT64_MARGIN, high + abs(high) * FLOAT64_MARGIN
    spacing = _ulp(most)
    inside = max(most - spacing * ulps, least)
    found = most + max(spacing, _ulp(inside)) * ulps
    return _down(min(found, max(high, 0.0) * _FAR))


@compiled
def within_ulp(low: Ends, high: Ends, ulps_low: Ends, ulps_high: Ends, count: int) -> Any:
    """Float32 within some ULP of numbers between two different ends."""
    first, last, look = np.empty(count), np.empty(count), 0
    for i in range(count):
        x = _settled_low(_least(at(low, i), at(high, i), at(ulps_low, i)))
        y = _settled_high(_most(at(low, i), at(high, i), at(ulps_high, i)))
        first[i], last[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return first, last, look


@compiled
def divide(
    x_low: Ends, x_high: Ends, y_low: Ends, y_high: Ends, ulps: float, near: float, far: float, count: int
) -> Any:
    """x / y within some ULP; looked at where |y| may lie below `near` or above `far`."""
    low, high, look = np.empty(count), np.empty(count), 0
    for i in range(count):
        p, q, u, v = at(x_low, i), at(x_high, i), at(y_low, i), at(y_high, i)
        look |= (max(u, -v) < near) | (max(abs(u), abs(v)) > far)
        negative = v < 0.0
        least, most = (-q if negative else p), (-p if negative else q)
        small, large = (-v if negative else u), (-u if negative else v)
        a, b = min(least / large, least / small), max(most / small, most / large)
        x, y = _settled_low(_least(a, b, ulps)), _settled_high(_most(a, b, ulps))
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return low, high, look


@inlined
def _inverse_root(low: Any, high: Any, ulps: Any) -> Any:
    near, far = 1.0 / np.sqrt(max(high, SMALLEST)), 1.0 / np.sqrt(max(low, SMALLEST))
    return _settled_low(_least(near, far, ulps)), _settled_high(_most(near, far, ulps))


@compiled
def inverse_square_root(x_low: Ends, x_high: Ends, ulps: float, count: int) -> Any:
    """1 / sqrt(x); looked at where x may be 0 or less."""
    low, high, look = np.empty(count), np.empty(count), 0
    for i in range(count):
        p, q = at(x_low, i), at(x_high, i)
        x, y = _inverse_root(p, q, ulps)
        low[i], high[i] = x, y
        look |= (p <= 0.0) | (y > LARGEST)
    return low, high, look


@compiled
def square_root(
    x_low: Ends, x_high: Ends, ulps: float, ulps_divide: float, near: float, far: float, count: int
) -> Any:
    """1 / (1 / sqrt(x)), each within its ULP, 0 where x may be 0; looked at where x may be negative."""
    low, high, look = np.empty(count), np.empty(count), 0
    for i in range(count):
        p, q = at(x_low, i), at(x_high, i)
        u, v = _inverse_root(p, q, ulps)
        least, most = 1.0 / v, 1.0 / u
        x, y = _settled_low(_least(least, most, ulps_divide)), _settled_high(_most(least, most, ulps_divide))
        x, y = (0.0 if p < SMALLEST else x), (0.0 if q <= 0.0 else y)
        low[i], high[i] = x, y
        look |= (p < 0.0) | (u < near) | (v > far) | (y > LARGEST)
    return low, high, look


@inlined
def _add(a_low: Any, a_high: Any, b_low: Any, b_high: Any) -> Any:
    return _settled_low(_sum_down(a_low, b_low)), _settled_high(_sum_up(a_high, b_high))


@compiled
def sum_of_three(
    a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, c_low: Ends, c_high: Ends, count: int
) -> Any:
    """The hull of the sums of three terms over all groupings, each rounded to either neighbour."""
    low, high, look = np.empty(count), np.empty(count), 0
    for i in range(count):
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
    return low, high, look


@compiled
def choose(true: Ends, false: Ends, a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, count: int) -> Any:
    """a where a condition holds, b where it does not, the hull where it may do either."""
    low, high = np.empty(count), np.empty(count)
    for i in range(count):
        t, f = at(true, i), at(false, i)
        p, q, r, s = at(a_low, i), at(b_low, i), at(a_high, i), at(b_high, i)
        low[i] = min(p, q) if t & f else (p if t else q)
        high[i] = max(r, s) if t & f else (r if t else s)
    return low, high


@compiled
def multiply_nearest(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, count: int) -> Any:
    """Ends of the exact products; and of a b, rounded to nearest."""
    low, high, look = np.empty(count), np.empty(count), 0
    least, most = np.empty(count), np.empty(count)
    for i in range(count):
        p, q = at(a_low, i) * at(b_low, i), at(a_high, i) * at(b_low, i)
        r, s = at(a_low, i) * at(b_high, i), at(a_high, i) * at(b_high, i)
        u, v = min(min(p, q), min(r, s)), max(max(p, q), max(r, s))
        x, y = _settled_low(_nearest(u)), _settled_high(_nearest(v))
        least[i], most[i], low[i], high[i] = u, v, x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return least, most, low, high, look


@compiled
def add_nearest(a_low: Ends, a_high: Ends, b_low: Ends, b_high: Ends, count: int) -> Any:
    """a + b rounded to nearest; below the normal numbers nothing is settled."""
    low, high = np.empty(count), np.empty(count)
    for i in range(count):
        low[i], high[i] = _nearest(at(a_low, i) + at(b_low, i)), _nearest(at(a_high, i) + at(b_high, i))
    return low, high


@compiled
def fuse(low: Ends, high: Ends, least: Ends, most: Ends, b_low: Ends, b_high: Ends, count: int) -> None:
    """Widen sums rounded to nearest, in place, by those of an exact product with b."""
    for i in range(count):
        low[i] = min(low[i], _sum_down(at(least, i), at(b_low, i)))
        high[i] = max(high[i], _sum_up(at(most, i), at(b_high, i)))


@compiled
def settle(low: Ends, high: Ends, count: int) -> Any:
    """Ends that may flush, in place."""
    look = 0
    for i in range(count):
        x, y = _settled_low(low[i]), _settled_high(high[i])
        low[i], high[i] = x, y
        look |= (x < -LARGEST) | (y > LARGEST)
    return look
