"""Float32 numbers inside float64 arrays: neighbours, spacing, and the error that float64 itself makes.

Every function takes and gives float64 arrays. The float32 grid is the one of normal numbers; what happens
below 2^-126 is decided in codegen.intervals.arithmetic.settle.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

SMALLEST = 2.0**-126
"""The smallest normal float32."""
LARGEST = float(np.finfo(np.float32).max)
DENORMAL_STEP = 2.0**-149

FLOAT64_MARGIN = 2.0**-49
"""Relative error that is granted to one float64 operation or elementary function: 8 of its ULP.

numpy's vector routines state at most 4 ULP (numpy, "SIMD math", simd/ufuncs); glibc's state less.
"""

PER_ULP = 1.0 + 2.0**-20
"""Granted on a number of ULP that varies with the argument: it may then be taken at the interval's ends."""

# The 29 bits of a float64 significand that a float32 significand lacks.
_EXTRA = np.int64((1 << 29) - 1)
_KEPT = np.int64(~((1 << 29) - 1))
_EXPONENT = np.int64(0x7FF << 52)
_SMALLEST_BITS = np.float64(SMALLEST).view(np.int64)
EXACT_SPAN = 2.0**27
"""Magnitudes of float32 numbers within this ratio have sums that float64 holds: 24 + 27 + 2 bits."""

Reach = tuple[float, float, float]
"""Least lower end, greatest upper end and least magnitude of any end of some intervals; NaN beside NaN."""


def down(x: Array) -> Array:
    """The largest float32 at or below x."""
    bits = x.view(np.int64)
    moved = bits >> 63
    moved &= _EXTRA
    moved += bits
    moved &= _KEPT
    return moved.view(np.float64)


def up(x: Array) -> Array:
    """The smallest float32 at or above x."""
    bits = x.view(np.int64)
    moved = bits >> 63
    np.invert(moved, out=moved)
    moved &= _EXTRA
    moved += bits
    moved &= _KEPT
    return moved.view(np.float64)


def select(mask: Array, a: Array, b: Array) -> Array:
    """a where the mask is set, else b, for 8-byte numbers; as quick for any mask, which np.where is not."""
    keep = mask.astype(np.int64)
    np.negative(keep, out=keep)
    other = b.view(np.int64)
    return np.asarray((((a.view(np.int64) ^ other) & keep) ^ other).view(b.dtype))


def nearest(x: Array) -> Array:
    """The float32 nearest to x, ties to even; infinite above the largest."""
    return x.astype(np.float32).astype(np.float64)


def ulp(x: Array) -> Array:
    """The distance of the two float32 around x; at a power of two the larger of its two distances.

    Muller's definition (inria-00070503), which all the specifications cite, leaves powers of two to the
    reader; the larger distance never refuses a conforming result.
    """
    bits = x.view(np.int64) & _EXPONENT
    np.maximum(bits, _SMALLEST_BITS, out=bits)
    return np.asarray(bits.view(np.float64) * 2.0**-23)


def reach(low: Array, high: Array) -> Reach:
    """How far the intervals between two arrays of ends reach."""
    bottom, top = float(low.min()), float(high.max())
    if bottom > 0.0:
        return bottom, top, bottom
    if top < 0.0:
        return bottom, top, -top
    near = float(np.abs(low).min())
    return bottom, top, near if high is low else min(near, float(np.abs(high).min()))


def usual(found: Reach) -> bool:
    """Whether every end is an ordinary float32: neither 0, below the normal numbers, above all, nor NaN."""
    bottom, top, near = found
    return near >= SMALLEST and bottom >= -LARGEST and top <= LARGEST


def exact_sums(a: Reach, b: Reach) -> bool:
    """Whether float64 holds every sum of two float32 of these intervals without rounding."""
    near = min(a[2], b[2])
    return near >= SMALLEST and max(-a[0], a[1], -b[0], b[1]) <= near * EXACT_SPAN


def sum_down(x: Array, y: Array) -> Array:
    """The largest float32 at or below the exact sum of two float32, or of float32 and a product of two."""
    total = x + y
    found = down(total)
    # Between two float32, float64 rounding changes nothing; on one, it may hide on which side the sum is.
    suspects = np.flatnonzero(found == total)
    if len(suspects):
        past = suspects[_sum_error(_at(x, suspects), _at(y, suspects), total[suspects]) < 0.0]
        if len(past):
            found[past] = down(np.nextafter(total[past], -np.inf))
    return found


def sum_up(x: Array, y: Array) -> Array:
    """The smallest float32 at or above the exact sum."""
    total = x + y
    found = up(total)
    suspects = np.flatnonzero(found == total)
    if len(suspects):
        past = suspects[_sum_error(_at(x, suspects), _at(y, suspects), total[suspects]) > 0.0]
        if len(past):
            found[past] = up(np.nextafter(total[past], np.inf))
    return found


def _at(x: Array, lanes: Array) -> Array:
    return x if len(x) == 1 else np.asarray(x[lanes])


def _sum_error(x: Array, y: Array, total: Array) -> Array:
    """What float64 lost: exact sum minus total (Knuth's two-sum)."""
    share = total - x
    return np.asarray((x - (total - share)) + (y - share))
