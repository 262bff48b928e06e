"""Integral over the highlights of a cylinder."""

from typing import Annotated

from shaderlib.constants import TINY_SQUARE
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import Interval, dot, f32, helper, inverse_sqrt, max, vec2
from shaderlib.lobes.half_sum import half_sum
from shaderlib.lobes.satin_highlight_range import satin_highlight_range
from shaderlib.lobes.satin_pair import satin_pair

# Gauss-Legendre abscissae on [-1, 1], the positive half, each followed by its weight.
TWELVE_NODE_1 = 0.125233408511468916
TWELVE_WEIGHT_1 = 0.249147045813402785
TWELVE_NODE_2 = 0.367831498998180194
TWELVE_WEIGHT_2 = 0.233492536538354809
TWELVE_NODE_3 = 0.587317954286617447
TWELVE_WEIGHT_3 = 0.203167426723065922
TWELVE_NODE_4 = 0.769902674194304687
TWELVE_WEIGHT_4 = 0.160078328543346226
TWELVE_NODE_5 = 0.904117256370474857
TWELVE_WEIGHT_5 = 0.106939325995318431
TWELVE_NODE_6 = 0.981560634246719251
TWELVE_WEIGHT_6 = 0.0471753363865118272
EIGHT_NODE_1 = 0.183434642495649805
EIGHT_WEIGHT_1 = 0.362683783378361983
EIGHT_NODE_2 = 0.525532409916328986
EIGHT_WEIGHT_2 = 0.313706645877887287
EIGHT_NODE_3 = 0.796666477413626740
EIGHT_WEIGHT_3 = 0.222381034453374471
EIGHT_NODE_4 = 0.960289856497536232
EIGHT_WEIGHT_4 = 0.101228536290376259

# Half widths of the integration range in standard deviations of the peak; 7e-6 and 5e-4 of it are cut off.
TWELVE_DEVIATIONS = 4.5
EIGHT_DEVIATIONS = 3.5


@helper
def satin_highlight(
    l: Direction, v: Direction, visible: Annotated[vec2, Interval(-1.6, 1.6)], exponent: Exponent
) -> f32:
    """Integral of (N.l) (N.v) (N.h)^exponent over the arc that l and v both see, by 12 nodes.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    visible   interval of the arc coordinate that both see; empty where its second end is not above the first
    exponent  sharpness of the facets
    returns   at least 0; 3e-5 of its mean (root mean square) and 4e-6 of its peak off
    form      Gauss-Legendre quadrature over the visible arc, cut to 4.5 deviations around the peak
    source    Gauss-Legendre quadrature
    """
    g = half_sum(l, v)
    h = inverse_sqrt(max(dot(g, g), TINY_SQUARE)) * g
    zone = satin_highlight_range(g, visible, exponent, TWELVE_DEVIATIONS)
    x = zone.x
    r = zone.y
    total = TWELVE_WEIGHT_1 * satin_pair(x, TWELVE_NODE_1 * r, l, v, h, exponent)
    total += TWELVE_WEIGHT_2 * satin_pair(x, TWELVE_NODE_2 * r, l, v, h, exponent)
    total += TWELVE_WEIGHT_3 * satin_pair(x, TWELVE_NODE_3 * r, l, v, h, exponent)
    total += TWELVE_WEIGHT_4 * satin_pair(x, TWELVE_NODE_4 * r, l, v, h, exponent)
    total += TWELVE_WEIGHT_5 * satin_pair(x, TWELVE_NODE_5 * r, l, v, h, exponent)
    total += TWELVE_WEIGHT_6 * satin_pair(x, TWELVE_NODE_6 * r, l, v, h, exponent)
    return r * total


@helper
def satin_highlight_eight(
    l: Direction, v: Direction, visible: Annotated[vec2, Interval(-1.6, 1.6)], exponent: Exponent
) -> f32:
    """Integral of (N.l) (N.v) (N.h)^exponent over the arc that l and v both see, by 8 nodes.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    visible   interval of the arc coordinate that both see; empty where its second end is not above the first
    exponent  sharpness of the facets
    returns   at least 0; 0.14 percent of its mean (root mean square) and 5e-4 of its peak off
    form      Gauss-Legendre quadrature over the visible arc, cut to 3.5 deviations around the peak
    source    Gauss-Legendre quadrature
    """
    g = half_sum(l, v)
    h = inverse_sqrt(max(dot(g, g), TINY_SQUARE)) * g
    zone = satin_highlight_range(g, visible, exponent, EIGHT_DEVIATIONS)
    x = zone.x
    r = zone.y
    total = EIGHT_WEIGHT_1 * satin_pair(x, EIGHT_NODE_1 * r, l, v, h, exponent)
    total += EIGHT_WEIGHT_2 * satin_pair(x, EIGHT_NODE_2 * r, l, v, h, exponent)
    total += EIGHT_WEIGHT_3 * satin_pair(x, EIGHT_NODE_3 * r, l, v, h, exponent)
    total += EIGHT_WEIGHT_4 * satin_pair(x, EIGHT_NODE_4 * r, l, v, h, exponent)
    return r * total
