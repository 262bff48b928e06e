"""Diffuse light from a row of parallel cylinders."""

from typing import Annotated

from shaderlib.constants import INV_PI, TINY_SQUARE
from shaderlib.domains import Direction
from shaderlib.lang import Interval, f32, helper, max, vec2
from shaderlib.lobes.arc_normal import arc_normal

# x - sin(x) = x^3 (CUBIC + x^2 (QUINTIC + x^2 SEPTIC)) on [0, 1], minimax in the relative error: 5.2e-7.
CUBIC = 0.166666582  # 3e2aaaa5
QUINTIC = -0.00833178964  # bc08820f
SEPTIC = 0.000194307228  # 394bbef3


@helper
def satin_diffuse(
    l: Direction,
    v: Direction,
    visible: Annotated[vec2, Interval(-1.6, 1.6)],
    pitch: Annotated[f32, Interval(0.0, 2.0)],
) -> f32:
    """Reflectance per steradian of white Lambert cylinders along x.

    l        direction to the light, in the local frame
    v        direction to the viewer, in the local frame
    visible  interval of the arc coordinate that both see; empty where its second end is not above the first
    pitch    distance between the axes of neighbours in radii
    returns  integral of (N.l) (N.v) over the interval, over pi pitch l.z v.z, N = (0, sin xi, cos xi)
    form     with N and T at the middle of the interval and its width x: (N.l) (N.v) (x + sin x) / 2 +
             (T.l) (T.v) (x - sin x) / 2, where x - sin x is a polynomial below 1. The textbook antiderivative
             cancels at grazing, where x -> 0 and N.l -> 0
    source   Poulin and Fournier 1990, A Model for Anisotropic Reflection; form derived for this library
    """
    x = max(visible.y - visible.x, 0.0)
    n = arc_normal(0.5 * (visible.x + visible.y))
    sine = arc_normal(x).y
    square = x * x
    series = x * square * (CUBIC + square * (QUINTIC + square * SEPTIC))
    difference = series if x < 1.0 else x - sine
    along = max(n.x * l.z + n.y * l.y, 0.0) * max(n.x * v.z + n.y * v.y, 0.0)
    across = (n.y * l.z - n.x * l.y) * (n.y * v.z - n.x * v.y)
    total = 0.5 * (along * (x + sine) + across * difference)
    return INV_PI * max(total, 0.0) / max(pitch * l.z * v.z, TINY_SQUARE)
