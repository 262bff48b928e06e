"""Dual-paraboloid map coordinates to direction."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import dot, vec2, vec3
from shaderlib.maps.domains import Border, MapHalf


def dual_paraboloid_direction(uv: UnitSquare, back: MapHalf, border: Border) -> vec3:
    """Direction of a point of a dual-paraboloid map; undoes dual_paraboloid_uv.

    uv       texture coordinates
    back     above 1/2: the half around -z; otherwise the half around +z
    border   half side of each square in units of the disc radius, at least 1
    returns  unit vector; in the rim, where |s| > 1, it lies across the equator, on the other half
    form     (2 s, 1 - s.s) / (1 + s.s), s = border (2 uv - 1), with z negated for the back
    source   Heidrich and Seidel 1998, View-independent Environment Maps
    """
    s = border * (2.0 * uv - vec2(1.0))
    square = dot(s, s)
    k = 1.0 / (1.0 + square)
    z = (1.0 - square) * k
    return vec3((2.0 * k) * s, -z if back > 0.5 else z)
