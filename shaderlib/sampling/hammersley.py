"""Hammersley points."""

from typing import Annotated

from shaderlib.lang import Interval, f32, i32, max, min, u32, vec2
from shaderlib.sampling.radical_inverse_base2 import radical_inverse_base2
from shaderlib.sampling.unit_float import STEP, unit_float

# 2^24: first coordinates are multiples of 1 / RESOLUTION.
RESOLUTION = 16777216.0


def hammersley(i: Annotated[u32, Interval(0, 1048575)], n: Annotated[u32, Interval(1, 1048576)]) -> vec2:
    """Point i of n of the Hammersley set in the unit square, bit-exact on every target.

    i           index of the point, 0 <= i < n
    n           number of points, at most 2^20
    returns     (floor(i 2^24 / n) 2^-24, unit_float(radical_inverse_base2(i))), both in [0, 1); (0, 0)
                first
    degenerate  i >= n counts as n - 1 in the first coordinate; n = 0 gives 2^-24 there
    form        the quotient in floats is off by at most 7.1 steps of 2^-24 (inverse 2.5 ulp, product 1 ulp,
                in any direction), so 8 below it lies 0 to 16.6 below i 2^24 / n. What is missing, times n,
                is a whole number below 2^25, known exactly modulo 2^32. Its own quotient in floats is off
                by less than 1e-5, so half below it, cut to a whole number, is right or one too small; one
                comparison decides. One division, no integer division (4 to 13 times slower on software
                drivers of GPUs)
    source      Hammersley 1960; exact quotient derived for this library
    """
    last = max(n, 1) - 1
    index = min(i, last)
    # Every number here is below 2^31: signed conversions, which vector units have, give the same.
    inverse_count = 1.0 / f32(i32(last + 1))
    low = u32(i32(max(f32(i32(index)) * inverse_count * RESOLUTION - 8.0, 0.0)))
    missing = (index << 24) - low * n
    more = u32(i32(max(f32(i32(missing)) * inverse_count - 0.5, 0.0)))
    quotient = low + more + (u32(1) if missing - more * n >= n else u32(0))
    return vec2(f32(i32(quotient)) * STEP, unit_float(radical_inverse_base2(i)))
