"""Float32 numbers inside float64 arrays: neighbours, spacing, and the error that float64 itself makes.

Every function takes and gives float64 arrays. The float32 grid is the one of normal numbers; what happens
below 2^-126 is decided in codegen.intervals.settle.
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

# The 29 bits of a float64 significand that a float32 significand lacks.
_EXTRA = np.int64((1 << 29) - 1)
_KEPT = np.int64(~((1 << 29) - 1))
_SIGNLESS = np.int64((1 << 63) - 1)
_EXPONENT = np.int64(0x7FF << 52)
_SMALLEST_BITS = np.float64(SMALLEST).view(np.int64)
_NORMAL_SPAN = np.uint64(int(np.float64(LARGEST).view(np.int64)) - int(_SMALLEST_BITS))


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


def unusual(x: Array) -> bool:
    """Whether any element is zero, below the normal numbers, above the largest float32, or NaN."""
    bits = x.view(np.int64) & _SIGNLESS
    bits -= _SMALLEST_BITS
    return bool((bits.view(np.uint64) > _NORMAL_SPAN).any())


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
