"""Octahedral map coordinates to direction."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import abs, max, normalize, vec2, vec3
from shaderlib.maps.octahedral_fold import octahedral_fold


def octahedral_decode(uv: UnitSquare) -> vec3:
    """Direction of a point of an octahedral map; undoes octahedral_encode.

    uv       texture coordinates; opposite points of an edge of the square mean one direction
    returns  unit vector
    form     p = 2 uv - 1, z = 1 - |p.x| - |p.y|; where z < 0 the fold moves p toward 0 by -z. The point of
             the octahedron is at least 1 / sqrt(3) from its centre, so normalising is safe
    source   Meyer, Suessmuth, Sussner, Stamminger and Greiner 2010, On Floating-Point Normal Vectors
    """
    p = 2.0 * uv - vec2(1.0)
    z = 1.0 - abs(p.x) - abs(p.y)
    return normalize(vec3(octahedral_fold(p, -max(-z, 0.0)), z))
