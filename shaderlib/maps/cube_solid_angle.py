"""Solid angle of a cube map texel."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import dot, f32, inverse_sqrt, vec2
from shaderlib.maps.domains import TexelCount


def cube_solid_angle(uv: UnitSquare, size: TexelCount) -> f32:
    """Solid angle of the texel centred at a point of one face of a cube map.

    uv       texture coordinates of the texel's centre on its face
    size     texels along each side of the face
    returns  4 / (size^2 (1 + p.p)^1.5) steradians, p = 2 uv - 1
    form     Jacobian of the central projection at the texel's centre
    source   elementary
    """
    p = 2.0 * uv - vec2(1.0)
    r = inverse_sqrt(1.0 + dot(p, p))
    side = 2.0 / size
    return side * side * (r * r * r)
