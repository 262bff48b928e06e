"""Orthonormal frame at a shaded point."""

from shaderlib.domains import Direction
from shaderlib.lang import struct


@struct
class Frame:
    """Right-handed orthonormal frame; local coordinates are x along the tangent, y bitangent, z normal.

    tangent    unit vector, x axis
    bitangent  unit vector, y axis: normal x tangent
    normal     unit vector, z axis
    """

    tangent: Direction
    bitangent: Direction
    normal: Direction
