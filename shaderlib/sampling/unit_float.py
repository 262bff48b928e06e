"""Random bits as a number in [0, 1)."""

from shaderlib.lang import f32
from shaderlib.sampling.integers import AnyInteger

# 2^-24, the distance of the floats below 1.
STEP = 5.9604644775390625e-8


def unit_float(bits: AnyInteger) -> f32:
    """Number in [0, 1) from the upper 24 of 32 bits.

    bits     uniform bits, for instance of pcg_hash or radical_inverse_base2
    returns  (bits >> 8) 2^-24, a multiple of 2^-24, at most 1 - 2^-24
    form     24 bits convert exactly; all 32 bits times 2^-32 would round to 1 from ffffff80 on
    source   elementary
    """
    return f32(bits >> 8) * STEP
