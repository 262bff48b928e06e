"""Part of a cylinder's arc on which its highlight is not negligible."""

from typing import Annotated

from shaderlib.constants import HALF_PI, TWO_PI
from shaderlib.domains import Exponent
from shaderlib.lang import Interval, f32, helper, inverse_sqrt, max, min, vec2, vec3
from shaderlib.numeric.turn_of import turn_of


@helper
def satin_highlight_range(
    g: Annotated[vec3, Interval(-2.0, 2.0)],
    visible: Annotated[vec2, Interval(-1.6, 1.6)],
    exponent: Exponent,
    deviations: Annotated[f32, Interval(1.0, 8.0)],
) -> vec2:
    """Middle and half width of the interval over which the highlight is integrated.

    g           half_sum of l and v, with g.z > 0
    visible     interval of the arc coordinate that l and v both see
    exponent    sharpness of the facets
    deviations  half width of the interval around the peak in units of 1 / sqrt(exponent + 1)
    returns     (middle, half width) of the visible interval cut to the highlight; half width 0 where they
                miss
    form        the peak lies at the angle of g in the plane across the cylinders
    source      derived for this library
    """
    peak = TWO_PI * turn_of(g.y, g.z)
    reach = min(deviations * inverse_sqrt(exponent + 1.0), HALF_PI)
    lower = max(visible.x, peak - reach)
    upper = min(visible.y, peak + reach)
    return vec2(0.5 * (lower + upper), 0.5 * max(upper - lower, 0.0))
