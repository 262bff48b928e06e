"""Van der Corput sequence in base 2."""

from shaderlib.lang import u32
from shaderlib.sampling.integers import AnyInteger


def radical_inverse_base2(i: AnyInteger) -> u32:
    """Radical inverse of an index in base 2: its 32 bits in reverse order.

    i        index of the point
    returns  the reversed bits; read as a 32-bit fraction they are the van der Corput sequence, see
             unit_float
    form     five exchanges of neighbouring groups of bits, as fast as a built-in where there is one
    source   van der Corput 1935; Warren 2002, Hacker's Delight, section 7-1
    """
    pairs = ((i & 0x55555555) << 1) | ((i >> 1) & 0x55555555)
    nibbles = ((pairs & 0x33333333) << 2) | ((pairs >> 2) & 0x33333333)
    octets = ((nibbles & 0x0F0F0F0F) << 4) | ((nibbles >> 4) & 0x0F0F0F0F)
    words = ((octets & 0x00FF00FF) << 8) | ((octets >> 8) & 0x00FF00FF)
    return (words << 16) | (words >> 16)
