"""The two weights with which a coat blends hair and skin."""

from shaderlib.domains import UnitInterval
from shaderlib.lang import struct


@struct
class FurWeights:
    """What hair and skin contribute to the light that leaves a coat.

    hair  weight of the reflectance of a single hair
    skin  weight of the reflectance of the skin
    """

    hair: UnitInterval
    skin: UnitInterval
