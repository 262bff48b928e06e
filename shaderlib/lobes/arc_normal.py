"""Normal of a circular arc."""

from typing import Annotated

from shaderlib.constants import INV_TWO_PI
from shaderlib.lang import Interval, abs, f32, helper, vec2
from shaderlib.sampling.unit_circle import unit_circle


@helper
def arc_normal(xi: Annotated[f32, Interval(-3.2, 3.2)]) -> vec2:
    """Cosine and sine of an angle in radians.

    xi       angle, in [-pi, pi]
    returns  (cos(xi), sin(xi))
    form     unit_circle of |xi| as a share of a turn; the built-ins are promised to 2^-11 only
    source   elementary
    """
    p = unit_circle(abs(xi) * INV_TWO_PI)
    return vec2(p.x, -p.y if xi < 0.0 else p.y)
