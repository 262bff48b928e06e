"""A vector split into its parts along a line and across it."""

from typing import Annotated

from shaderlib.domains import Direction
from shaderlib.lang import Length, dot, vec3


def line_component(x: Annotated[vec3, Length(1.0e-3, 1.0)], t: Direction) -> vec3:
    """Part of x along the line of t.

    x        vector; rounding is proportional to its length
    t        unit vector along the line, either way
    returns  x_T = (x.t) t
    form     orthogonal projection onto a line; the lecture's |x_T| = x.t holds up to the sign
    source   Banks 1994; lecture VGP352 week 6, projections
    """
    return dot(x, t) * t
