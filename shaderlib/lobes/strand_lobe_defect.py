"""Defect of the strand cosine for a strand along x."""

from shaderlib.domains import Direction
from shaderlib.lang import f32, helper, length, min, vec2


@helper
def strand_lobe_defect(l: Direction, v: Direction) -> f32:
    """Defect 1 - cos(delta) of the angle delta by which l misses the cone of mirror directions around x.

    l        direction to the light, in the local frame
    v        direction to the viewer, in the local frame
    returns  ((s_l - s_v)^2 + (l.x + v.x)^2) / 2, s the distance from the x axis; in [0, 2]
    form     sum of two squares: of second order in the rounding of the lengths. The equal product
             (l.x + v.x)^2 (1 + ((v.x - l.x) / (s_l + s_v))^2) / 2 is of first order, 8e-3 off at exponent 1e5
    source   the defect of strand_angles, for the tangent (1, 0, 0)
    """
    difference = length(vec2(l.y, l.z)) - length(vec2(v.y, v.z))
    along = l.x + v.x
    return min(0.5 * (difference * difference + along * along), 2.0)
