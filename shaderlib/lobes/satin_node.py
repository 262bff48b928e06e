"""One node of the integral over the highlights of a cylinder."""

from typing import Annotated

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import Interval, f32, helper, max, min
from shaderlib.lobes.arc_normal import arc_normal
from shaderlib.lobes.cosine_power import cosine_power


@helper
def satin_node(
    xi: Annotated[f32, Interval(-1.6, 1.6)], l: Direction, v: Direction, h: Direction, exponent: Exponent
) -> f32:
    """Integrand (N.l) (N.v) (N.h)^exponent at one point of the arc, N = (0, sin xi, cos xi).

    xi        arc coordinate, in radians
    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    h         half vector
    exponent  sharpness of the facets
    returns   at least 0
    form      cosine_power of (N.h)^2 and of 1 - (N.h)^2 = h.x^2 + (T.h)^2, T the tangent of the arc
    source    Poulin and Fournier 1990; form derived for this library
    """
    n = arc_normal(xi)
    facing = max(n.x * l.z + n.y * l.y, 0.0) * max(n.x * v.z + n.y * v.y, 0.0)
    across = n.y * h.z - n.x * h.y
    upright = n.x * h.z + n.y * h.y
    return facing * cosine_power(min(h.x * h.x + across * across, 1.0), upright * upright, exponent)
