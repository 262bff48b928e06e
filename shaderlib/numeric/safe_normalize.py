"""Unit vector of a vector of any length."""

from typing import Annotated

from shaderlib.constants import TINY_SQUARE
from shaderlib.domains import AnyLength, Direction
from shaderlib.lang import Length, abs, dot, inverse_sqrt, max, variant, vec3

# Powers of two, so that scaling is exact. The square of a component scaled up is at most 2^120; scaled down,
# a largest component of 1 to 1e30 has a square in 2^-100 (far above the denormals) to 2^100.
SCALE_UP = 1152921504606846976.0  # 2^60
SCALE_DOWN = 8.8817841970012523e-16  # 2^-50


def safe_normalize(x: AnyLength, fallback: Direction) -> vec3:
    """Unit vector along x for any length from 1e-30 to 1e30, and a chosen direction for the zero vector.

    x           vector to normalise
    fallback    unit vector to return for the zero vector
    returns     x / |x|
    degenerate  x = 0, and |x| below 3e-37, where a driver may flush x to zero: fallback
    form        one exact power of two brings every length to where squares neither overflow nor vanish. The
                built-in gives NaN or a wrong length below 1e-19 and above 1e19, as its squares do
    source      scaling derived for this library
    """
    largest = max(max(abs(x.x), abs(x.y)), abs(x.z))
    scaled = (SCALE_UP if largest < 1.0 else SCALE_DOWN) * x
    squared = dot(scaled, scaled)
    unit = inverse_sqrt(max(squared, TINY_SQUARE)) * scaled
    return unit if squared > TINY_SQUARE else fallback


@variant("safe_normalize")
def safe_normalize_dot(x: Annotated[vec3, Length(1.0e-15, 1.0e18)], fallback: Direction) -> vec3:
    """Unit vector along x for ordinary lengths, and a chosen direction for the zero vector.

    x           vector to normalise, of length 1e-15 to 1e18, or zero
    fallback    unit vector to return for the zero vector
    returns     x / |x|
    degenerate  x = 0, and |x| below 3e-19: fallback
    form        x / sqrt(x.x) with a test of the square. Squares of components vanish below 1e-19 and
                overflow above 1e19; from 1e-15 on what vanishes is below rounding
    source      elementary
    """
    squared = dot(x, x)
    unit = inverse_sqrt(max(squared, TINY_SQUARE)) * x
    return unit if squared > TINY_SQUARE else fallback


@variant("safe_normalize")
def safe_normalize_nonzero(x: Annotated[vec3, Length(1.0e-15, 1.0e18)], fallback: Direction) -> vec3:
    """Unit vector along x for ordinary lengths, where x is known not to be zero.

    x           vector to normalise, of length 1e-15 to 1e18
    fallback    not used: what computes it can be left out
    returns     x / |x|
    degenerate  x = 0: the zero vector
    form        x / sqrt(x.x), finite for every x in the domain, without a test
    source      elementary
    """
    return inverse_sqrt(max(dot(x, x), TINY_SQUARE)) * x
