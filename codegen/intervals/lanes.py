"""What the compiled loops do with one lane: neighbours among float32, sums, what may flush, and ULP.

These are the scalar forms of codegen.intervals.numbers and codegen.intervals.arithmetic, as parts of compiled
functions. Imported only where numba is installed, see codegen.intervals.compiled.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.extending import overload

from codegen.intervals.numbers import FLOAT64_MARGIN, PER_ULP, SMALLEST

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
def bits(x: Any) -> Any:
    return np.float64(x).view(np.int64)


@inlined
def of_bits(x: Any) -> Any:
    return np.int64(x).view(np.float64)


@inlined
def down(x: Any) -> Any:
    """The largest float32 at or below x."""
    b = bits(x)
    return of_bits((b + ((b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def up(x: Any) -> Any:
    """The smallest float32 at or above x."""
    b = bits(x)
    return of_bits((b + (~(b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def nearest(x: Any) -> Any:
    """The float32 nearest to x."""
    return np.float64(np.float32(x))


@inlined
def lost(x: Any, y: Any, total: Any) -> Any:
    """What float64 lost in a sum (Knuth's two-sum)."""
    share = total - x
    return (x - (total - share)) + (y - share)


@inlined
def sum_down(x: Any, y: Any) -> Any:
    total = x + y
    b = bits(total)
    b -= (1 | (b >> 63)) if lost(x, y, total) < 0.0 else 0  # the float64 below
    return of_bits((b + ((b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def sum_up(x: Any, y: Any) -> Any:
    total = x + y
    b = bits(total)
    b += (1 | (b >> 63)) if lost(x, y, total) > 0.0 else 0  # the float64 above
    return of_bits((b + (~(b >> 63) & (_STEP - 1))) & _KEPT)


@inlined
def settled_low(x: Any) -> Any:
    """A lower end that may flush."""
    flushed = 0.0 if x >= 0.0 else -SMALLEST
    return flushed if abs(x) < SMALLEST else x


@inlined
def settled_high(x: Any) -> Any:
    """An upper end that may flush."""
    flushed = 0.0 if x <= 0.0 else SMALLEST
    return flushed if abs(x) < SMALLEST else x


@inlined
def _ulp(x: Any) -> Any:
    """The distance of the float32 around x, with what is granted on varying numbers of ULP."""
    return of_bits(max(bits(x) & _EXPONENT, _SMALLEST_BITS)) * 2.0**-23 * PER_ULP


@inlined
def least_within(low: Any, high: Any, ulps: Any) -> Any:
    """The least float32 within some ULP of numbers between two ends, its sign kept."""
    least, most = low - abs(low) * FLOAT64_MARGIN, high + abs(high) * FLOAT64_MARGIN
    spacing = _ulp(least)
    inside = min(least + spacing * ulps, most)
    found = least - max(spacing, _ulp(inside)) * ulps
    return up(max(found, min(low, 0.0) * _FAR))


@inlined
def most_within(low: Any, high: Any, ulps: Any) -> Any:
    """The greatest float32 within some ULP of numbers between two ends, its sign kept."""
    least, most = low - abs(low) * FLOAT64_MARGIN, high + abs(high) * FLOAT64_MARGIN
    spacing = _ulp(most)
    inside = max(most - spacing * ulps, least)
    found = most + max(spacing, _ulp(inside)) * ulps
    return down(min(found, max(high, 0.0) * _FAR))
