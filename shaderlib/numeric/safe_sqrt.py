"""Square root that takes a slightly negative number for zero."""

from typing import Annotated

from shaderlib.lang import Interval, f32, max, sqrt


def safe_sqrt(x: Annotated[f32, Interval(-1.0, 1.0e30, scale="log")]) -> f32:
    """Square root of x, and 0 for negative x.

    x           number; what rounding pushed below zero counts as zero
    returns     sqrt(max(x, 0)), at least 0
    degenerate  x < 0: 0
    form        WGSL leaves the root of a negative number undefined; 1 - c * c is negative for one in six
                float32 pairs of nearly parallel unit vectors
    source      elementary
    """
    return sqrt(max(x, 0.0))
