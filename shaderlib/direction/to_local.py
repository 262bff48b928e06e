"""World direction to frame coordinates."""

from shaderlib.direction.frame import Frame
from shaderlib.domains import Direction
from shaderlib.lang import dot, vec3


def to_local(frame: Frame, w: Direction) -> vec3:
    """Coordinates of a world-space vector in a frame.

    frame    orthonormal frame in world space
    w        vector in world space
    returns  (w.tangent, w.bitangent, w.normal)
    form     product with the transposed rotation
    source   elementary
    """
    return vec3(dot(frame.tangent, w), dot(frame.bitangent, w), dot(frame.normal, w))
