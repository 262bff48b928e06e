"""The part of a vector across a line."""

from typing import Annotated

from shaderlib.domains import Direction
from shaderlib.lang import Length, dot, vec3


def line_rejection(x: Annotated[vec3, Length(1.0e-3, 1.0)], t: Direction) -> vec3:
    """Part of x across the line of t.

    x        vector; rounding is proportional to its length
    t        unit vector along the line, either way
    returns  x_N = x - x_T, orthogonal to t
    form     Gram-Schmidt. The error is absolute: for x within 1e-3 rad of t only three digits of x_N are
             left. For the length alone use sin_angle, for a frame frame_from_tangent: both are flat
    source   Banks 1994; lecture VGP352 week 6, projections
    """
    return x - dot(x, t) * t
