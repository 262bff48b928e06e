"""Frame coordinates to world direction."""

from shaderlib.direction.frame import Frame
from shaderlib.domains import Direction
from shaderlib.lang import vec3


def to_world(frame: Frame, w: Direction) -> vec3:
    """World-space vector of coordinates in a frame; undoes to_local.

    frame    orthonormal frame in world space
    w        vector in the frame: x along its tangent, y bitangent, z normal
    returns  w.x tangent + w.y bitangent + w.z normal
    form     product with the rotation
    source   elementary
    """
    return w.x * frame.tangent + w.y * frame.bitangent + w.z * frame.normal
