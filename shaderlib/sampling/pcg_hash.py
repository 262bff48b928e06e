"""One-dimensional integer hash."""

from shaderlib.lang import u32
from shaderlib.sampling.integers import AnyInteger


def pcg_hash(x: AnyInteger) -> u32:
    """Hash of an integer: one step of the PCG generator and its permutation (RXS-M-XS 32), a bijection.

    x        any number
    returns  32 well-mixed bits; 0 gives 07bb2fe2, 1 gives a8beea3c
    form     integers only, so every target agrees; fract(sin(x)) differs from driver to driver
    source   O'Neill 2014, PCG; Jarzynski and Olano 2020, Hash Functions for GPU Rendering
    """
    state = x * 747796405 + 2891336453
    word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737
    return (word >> 22) ^ word
