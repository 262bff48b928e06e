"""Solid angle of an octahedral texel."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import abs, dot, f32, inverse_sqrt, max, vec2, vec3
from shaderlib.maps.domains import TexelCount
from shaderlib.maps.octahedral_fold import octahedral_fold


def octahedral_solid_angle(uv: UnitSquare, size: TexelCount) -> f32:
    """Solid angle of the texel centred at a point of an octahedral map.

    uv       texture coordinates of the texel's centre
    size     texels along each side
    returns  4 / (size^2 |q|^3) steradians, q the point of the octahedron |x| + |y| + |z| = 1; the sum over a
             map is 4 pi to 2e-6 at 16 x 16
    form     area of the texel on the face times cosine over squared distance: the face is 1 / sqrt(3) from
             the centre and its projection along z is enlarged by sqrt(3)
    source   derived for this library
    """
    p = 2.0 * uv - vec2(1.0)
    z = 1.0 - abs(p.x) - abs(p.y)
    q = vec3(octahedral_fold(p, -max(-z, 0.0)), z)
    r = inverse_sqrt(dot(q, q))
    side = 2.0 / size
    return side * side * (r * r * r)
