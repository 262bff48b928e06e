"""A place in a dual-paraboloid map."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import struct
from shaderlib.maps.domains import MapHalf


@struct
class DualParaboloid:
    """A place in a dual-paraboloid map.

    uv    texture coordinates in [0, 1]^2
    back  1 for the half around -z, 0 for the half around +z
    """

    uv: UnitSquare
    back: MapHalf
