"""Direction around an axis from its defect and its azimuth."""

from shaderlib.domains import CosineDefect, UnitInterval
from shaderlib.lang import helper, max, sqrt, vec3
from shaderlib.sampling.unit_circle import unit_circle


@helper
def around_axis(q: CosineDefect, turns: UnitInterval) -> vec3:
    """Unit vector at a given defect from the z axis.

    q        defect 1 - cos of the angle to the z axis
    turns    azimuth as a share of a full turn from the x axis
    returns  (sin cos(2 pi turns), sin sin(2 pi turns), 1 - q) with sin = sqrt(q (2 - q))
    form     the sine comes from the defect, not from the rounded cosine
    source   elementary
    """
    return vec3(sqrt(max(q * (2.0 - q), 0.0)) * unit_circle(turns), 1.0 - q)
