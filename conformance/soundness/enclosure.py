"""Enclosures of exact real values: float64 intervals that surely hold the value of exact arithmetic.

Nothing of codegen.intervals is used: this is what its results are held against. A sum whose rounding error is
0 stays exact (Knuth's two-sum), and so do products of numbers that have 24 bits; everything else is widened
by more than float64 can err. An operation outside its domain gives the whole line.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

STEP = 2.0**-52
"""Relative distance that is at least one float64 step."""
TINY = 2.0**-1022
"""Granted to every inexact operation, for results that are denormal in float64."""
ELEMENTARY = 2.0**-49
"""Relative error granted to an elementary function: 8 ULP; numpy's state at most 4, glibc's less."""
LARGEST_ANGLE = 1e6
"""Beyond it nothing is said of sines: their extremes could not be told from rounding."""


@dataclass(eq=False, slots=True)
class Enclosure:
    """Lower and upper ends, float64 (N,); `short`: both have 24 bits, so that products are exact."""

    low: Array
    high: Array
    short: bool = False

    @property
    def is_point(self) -> bool:
        return self.low is self.high


def point(a: Array) -> Enclosure:
    """Numbers of 24 bits, known exactly."""
    return Enclosure(a, a, short=True)


def _below(x: Array) -> Array:
    return np.asarray(x - np.abs(x) * STEP - TINY)


def _above(x: Array) -> Array:
    return np.asarray(x + np.abs(x) * STEP + TINY)


def _checked(low: Array, high: Array) -> Enclosure:
    """An enclosure whose ends are infinite where they are no numbers."""
    return Enclosure(np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high))


def _error(x: Array, y: Array, total: Array) -> Array:
    share = total - x
    return np.asarray((x - (total - share)) + (y - share))


def add(a: Enclosure, b: Enclosure) -> Enclosure:
    """a + b."""
    low = a.low + b.low
    lost = _error(a.low, b.low, low)
    if a.is_point and b.is_point and not lost.any():
        return Enclosure(low, low)
    high, more = (low, lost) if a.is_point and b.is_point else (a.high + b.high, None)
    if more is None:
        more = _error(a.high, b.high, high)
    # A NaN error comes from infinite ends: the sum is then infinite or NaN itself.
    return _checked(np.where(lost < 0.0, _below(low), low), np.where(more > 0.0, _above(high), high))


def negate(a: Enclosure) -> Enclosure:
    """-a."""
    low = -a.high
    return Enclosure(low, low if a.is_point else -a.low, a.short)


def multiply(a: Enclosure, b: Enclosure) -> Enclosure:
    """a b; a square where both are one value."""
    if a.is_point and b.is_point:
        low = high = a.low * b.low
    elif a is b:
        near = np.maximum(np.maximum(a.low, -a.high), 0.0)
        far = np.maximum(np.abs(a.low), np.abs(a.high))
        low, high, exact = near * near, far * far, _is_short(a)
        return _checked(
            np.where(exact, low, np.maximum(_below(low), 0.0)),
            np.where(exact | (far == 0.0), high, _above(high)),
        )
    elif a.is_point and a.short and not b.short:
        return _times(b, a.low)
    elif b.is_point and b.short and not a.short:
        return _times(a, b.low)
    else:
        corners = (a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high)
        low = np.minimum(np.minimum(corners[0], corners[1]), np.minimum(corners[2], corners[3]))
        high = np.maximum(np.maximum(corners[0], corners[1]), np.maximum(corners[2], corners[3]))
    if a.short and b.short:
        return Enclosure(low, high) if low is high else _checked(low, high)
    exact = _is_zero(a) | _is_zero(b) | (_is_short(a) & _is_short(b))
    return _checked(np.where(exact, low, _below(low)), np.where(exact, high, _above(high)))


def _times(a: Enclosure, number: Array) -> Enclosure:
    """An enclosure times a number of 24 bits. An end that has 24 bits too stays exact: 1 in 1 - exp(-x)."""
    ends = a.low * number, a.high * number
    exact = [(number == 0.0) | (end.astype(np.float32) == end) for end in (a.low, a.high)]
    below = [np.where(e, x, _below(x)) for x, e in zip(ends, exact, strict=True)]
    above = [np.where(e, x, _above(x)) for x, e in zip(ends, exact, strict=True)]
    return _checked(np.where(number < 0.0, below[1], below[0]), np.where(number < 0.0, above[0], above[1]))


def _is_short(a: Enclosure) -> Array:
    """Lanes that hold one number of 24 bits, such as the 0 and 1 of clamped values."""
    return np.asarray((a.low == a.high) & (a.low.astype(np.float32) == a.low))


def _is_zero(a: Enclosure) -> Array:
    return np.asarray((a.low == 0.0) & (a.high == 0.0))


def divide(a: Enclosure, b: Enclosure) -> Enclosure:
    """a / b; anything where b may be 0."""
    corners = (a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high)
    low = np.minimum(np.minimum(corners[0], corners[1]), np.minimum(corners[2], corners[3]))
    high = np.maximum(np.maximum(corners[0], corners[1]), np.maximum(corners[2], corners[3]))
    exact = _is_zero(a)
    if a.is_point and b.is_point and b.short:
        # The product of a quotient of 24 bits is exact: where it gives a back, the quotient is.
        exact |= (low.astype(np.float32) == low) & (low * b.low == a.low)
    low, high = np.where(exact, low, _below(low)), np.where(exact, high, _above(high))
    vanishes = (b.low <= 0.0) & (b.high >= 0.0)
    return _checked(np.where(vanishes, -np.inf, low), np.where(vanishes, np.inf, high))


def smaller(a: Enclosure, b: Enclosure) -> Enclosure:
    """min(a, b)."""
    low = np.minimum(a.low, b.low)
    both = a.is_point and b.is_point
    return Enclosure(low, low if both else np.minimum(a.high, b.high), a.short and b.short)


def larger(a: Enclosure, b: Enclosure) -> Enclosure:
    """max(a, b)."""
    return negate(smaller(negate(a), negate(b)))


def absolute(a: Enclosure) -> Enclosure:
    """|a|."""
    return larger(a, negate(a)) if a.is_point else _absolute(a)


def _absolute(a: Enclosure) -> Enclosure:
    low = np.maximum(np.maximum(a.low, -a.high), 0.0)
    return Enclosure(low, np.maximum(-a.low, a.high), a.short)


def choose(condition: Array, a: Enclosure, b: Enclosure) -> Enclosure:
    """Lane by lane one of two."""
    low = np.where(condition, a.low, b.low)
    both = a.is_point and b.is_point
    return Enclosure(low, low if both else np.where(condition, a.high, b.high), a.short and b.short)


def square_root(a: Enclosure) -> Enclosure:
    """sqrt(a); anything where a may be negative."""
    low = np.sqrt(a.low)
    high = low if a.is_point else np.sqrt(a.high)
    if a.is_point:
        exact = (low.astype(np.float32) == low) & (low * low == a.low)
        return _checked(np.where(exact, low, _below(low)), np.where(exact, low, _above(low)))
    high = np.where(a.high == 0.0, 0.0, _above(high))
    return _checked(np.where(a.low == 0.0, 0.0, _below(low)), np.where(a.low < 0.0, np.inf, high))


def increasing(function: Callable[[Array], Array], a: Enclosure) -> Enclosure:
    """A function that increases; anything where it is no number."""
    low, high = function(a.low), function(a.high)
    low, high = low - np.abs(low) * ELEMENTARY - TINY, high + np.abs(high) * ELEMENTARY + TINY
    unknown = np.isnan(low) | np.isnan(high)
    return Enclosure(np.where(unknown, -np.inf, low), np.where(unknown, np.inf, high))


def logarithm(function: Callable[[Array], Array], a: Enclosure) -> Enclosure:
    """A logarithm; anything where a may be 0 or less."""
    found = increasing(function, a)
    outside = a.low <= 0.0
    exact = (a.low == 1.0) & (a.high == 1.0)
    low, high = np.where(exact, 0.0, found.low), np.where(exact, 0.0, found.high)
    return Enclosure(np.where(outside, -np.inf, low), np.where(outside, np.inf, high))


def sine(a: Enclosure, quarter: float) -> Enclosure:
    """sin(a + quarter * pi / 2): the largest slope is 1, so that ends and their distance bound it."""
    function = np.cos if quarter else np.sin
    value = function(a.low)
    slack = (a.high - a.low) * (1.0 + STEP) + ELEMENTARY
    low, high = np.maximum(value - slack, -1.0), np.minimum(value + slack, 1.0)
    unknown = ~(np.maximum(np.abs(a.low), np.abs(a.high)) <= LARGEST_ANGLE)
    return Enclosure(np.where(unknown, -1.0, low), np.where(unknown, 1.0, high))


def arc_tangent(y: Enclosure, x: Enclosure) -> Enclosure:
    """atan2(y, x); anything where the box may hold the negative axis or the origin."""
    corners = [np.arctan2(b, a) for b in (y.low, y.high) for a in (x.low, x.high)]
    low, high = np.minimum.reduce(corners), np.maximum.reduce(corners)
    low, high = low - np.abs(low) * ELEMENTARY - TINY, high + np.abs(high) * ELEMENTARY + TINY
    cut = (y.low <= 0.0) & (y.high >= 0.0) & (x.low <= 0.0)
    return _checked(np.where(cut, -np.inf, low), np.where(cut, np.inf, high))
