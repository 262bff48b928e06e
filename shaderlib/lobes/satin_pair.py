"""Two symmetric nodes of the integral over the highlights of a cylinder."""

from typing import Annotated

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import Interval, f32, helper
from shaderlib.lobes.satin_node import satin_node


@helper
def satin_pair(
    middle: Annotated[f32, Interval(-1.6, 1.6)],
    offset: Annotated[f32, Interval(0.0, 1.6)],
    l: Direction,
    v: Direction,
    h: Direction,
    exponent: Exponent,
) -> f32:
    """Sum of satin_node at two points of the arc.

    middle    arc coordinate halfway between the points, in radians
    offset    distance of each from the middle
    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    h         half vector
    exponent  sharpness of the facets
    returns   satin_node(middle - offset) + satin_node(middle + offset)
    form      Gauss-Legendre nodes are symmetric
    source    elementary
    """
    return satin_node(middle - offset, l, v, h, exponent) + satin_node(middle + offset, l, v, h, exponent)
