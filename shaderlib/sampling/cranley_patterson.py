"""Shift of a point set, modulo 1."""

from typing import Annotated

from shaderlib.constants import ONE_BELOW
from shaderlib.lang import Interval, f32, helper, min, vec2

# Numbers in [0, 1), one or two.
Fraction = Annotated[f32, Interval(0.0, ONE_BELOW)]
Fractions = Annotated[vec2, Interval(0.0, ONE_BELOW)]


@helper
def wrapped_sum(a: Fraction, b: Fraction) -> f32:
    """Sum modulo 1 of two numbers in [0, 1).

    a        multiple of 2^-24 for an exact result
    b        multiple of 2^-24 for an exact result
    returns  a + b or a + b - 1, in [0, 1)
    form     b - 1 and a + (b - 1) lie in [-1, 1), so multiples of 2^-24 stay exact there; a + b needs a
             25th bit. Other inputs could round to 1: limited to 1 - 2^-24
    source   derived for this library
    """
    d = a + (b - 1.0)
    return min(d + 1.0 if d < 0.0 else d, ONE_BELOW)


def cranley_patterson(u: Fractions, shift: Fractions) -> vec2:
    """Rotation of a point on the unit torus: the same point set, decorrelated from pixel to pixel.

    u        point in [0, 1)^2
    shift    displacement in [0, 1)^2, for instance from a hash of the pixel
    returns  u + shift modulo 1, in [0, 1)^2; bit-exact on every target where both are multiples of 2^-24,
             as hammersley, r2_sequence and unit_float give them
    form     see wrapped_sum; fract(u + shift) is rounded for a quarter of all such pairs, in either
             direction
    source   Cranley and Patterson 1976, Randomization of Number Theoretic Methods for Multiple Integration
    """
    return vec2(wrapped_sum(u.x, shift.x), wrapped_sum(u.y, shift.y))
