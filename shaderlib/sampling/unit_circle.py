"""Point on the unit circle."""

from shaderlib.domains import UnitInterval
from shaderlib.lang import floor, helper, vec2
from shaderlib.sampling.eighth_turn import eighth_turn


@helper
def unit_circle(turns: UnitInterval) -> vec2:
    """Point on the unit circle at a share of a full turn from the x axis.

    turns    angle as a share of a full turn, in [0, 1]
    returns  (cos(2 pi turns), sin(2 pi turns)); exact at quarter turns
    form     the nearest quarter turn is subtracted exactly, which sin and cos of 2 pi turns cannot do
    source   derived for this library
    """
    quarters = 4.0 * turns
    nearest = floor(quarters + 0.5)
    p = eighth_turn(2.0 * (quarters - nearest))
    swapped = vec2(-p.y, p.x) if nearest == 1.0 or nearest == 3.0 else p
    return -swapped if nearest == 2.0 or nearest == 3.0 else swapped
