"""Angle across a cylinder as a share of half a turn."""

from shaderlib.domains import Direction
from shaderlib.lang import clamp, f32, helper
from shaderlib.numeric.turn_of import turn_of


@helper
def across_share(w: Direction) -> f32:
    """Angle of a direction about the tangent x, from -y over the normal z to y, as a coordinate from 0 to 1.

    w           direction in the local frame
    returns     atan2(w.y, w.z) / pi + 1/2, in [0, 1]
    degenerate  along the tangent: 1/2. Below the surface: 0 or 1, on the side of w.y
    form        turn_of; the arc sine of w.y over its length across loses half of the digits at the horizon
    source      elementary
    """
    return clamp(0.5 + 2.0 * turn_of(w.y, w.z), 0.0, 1.0)
