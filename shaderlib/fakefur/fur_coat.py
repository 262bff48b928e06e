"""The geometry of a fur coat."""

from shaderlib.fakefur.domains import HairDensity, HairLength, HairRadius
from shaderlib.lang import struct


@struct
class FurCoat:
    """Average geometry of the hairs around a point; one unit of length throughout.

    density      hairs per unit of skin area
    hair_length  length of a hair
    radius_base  radius of a hair at the skin, much smaller than hair_length
    radius_tip   radius of a hair at its tip
    """

    density: HairDensity
    hair_length: HairLength
    radius_base: HairRadius
    radius_tip: HairRadius
