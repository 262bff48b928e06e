"""Paraboloid map coordinates to direction."""

from typing import Annotated

from shaderlib.lang import Interval, dot, vec2, vec3


def parabolic_direction(uv: Annotated[vec2, Interval(-1000.0, 1000.0)]) -> vec3:
    """Direction of a point of a paraboloid map around +z; undoes parabolic_uv.

    uv       texture coordinates; points outside the disc of radius 1/2 around (1/2, 1/2) look down
    returns  unit vector (2 s, 1 - s.s) / (1 + s.s), s = 2 uv - 1
    form     rational; no square root, no pole
    source   Heidrich and Seidel 1998, View-independent Environment Maps
    """
    s = 2.0 * uv - vec2(1.0)
    square = dot(s, s)
    k = 1.0 / (1.0 + square)
    return vec3((2.0 * k) * s, (1.0 - square) * k)
