"""Roberts' R2 sequence."""

from shaderlib.lang import u32, vec2
from shaderlib.sampling.integers import AnyInteger
from shaderlib.sampling.unit_float import unit_float

# 2^32 / g and 2^32 / g^2 for g = 1.3247..., the root of g^3 = g + 1, rounded to odd numbers: an odd factor
# makes the sequence visit all 2^32 values, the even neighbour of the second one only half of them.
FIRST_FACTOR: u32 = 3242174889
SECOND_FACTOR: u32 = 2447445413


def r2_sequence(i: AnyInteger) -> vec2:
    """Point i of the R2 sequence in the unit square, bit-exact on every target.

    i        index of the point; the sequence needs no length and starts at (0, 0)
    returns  both fractional parts of i / g and i / g^2, as multiples of 2^-24 in [0, 1)
    form     in fixed point modulo 2^32: no loss for large i, where fract(i * 0.7548) has no correct digit
             left
    source   Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences
    """
    return vec2(unit_float(i * FIRST_FACTOR), unit_float(i * SECOND_FACTOR))
