"""How far a strand is from mirroring the light to the viewer."""

from shaderlib.direction.sin_angle import sin_angle
from shaderlib.domains import Direction
from shaderlib.lang import dot, f32, helper, sqrt


@helper
def strand_defect(t: Direction, l: Direction, v: Direction) -> f32:
    """Defect 1 - strand_cosine of a strand.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  ((sin_l - sin_v)^2 + (t.(l + v))^2) / 2, in [0, 2] up to rounding
    form     a sum of squares: exact to second order on the highlight
    source   identity derived for this library
    """
    across = sin_angle(t, l) - sin_angle(t, v)
    along = dot(t, l + v)
    return 0.5 * (across * across + along * along)


@helper
def strand_defect_half(t: Direction, l: Direction, v: Direction) -> f32:
    """Defect 1 - strand_cosine of a strand by half angles: a square, from four squared lengths.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  (|t + l| |t + v| - |t - l| |t - v|)^2 / 8, in [0, 2] up to rounding
    form     for the angles a, b of light and viewer to the strand the defect is 1 + cos(a + b), which is
             2 cos((a + b) / 2)^2, with |t + l| = 2 cos(a / 2) and |t - l| = 2 sin(a / 2). Like strand_defect
             it has a zero of second order on the highlight; up to twice its error, two thirds of the work
    source   double-angle formula; derived for this library
    """
    far_l = t - l
    near_l = t + l
    far_v = t - v
    near_v = t + v
    cosines = sqrt(dot(near_l, near_l) * dot(near_v, near_v))
    sines = sqrt(dot(far_l, far_l) * dot(far_v, far_v))
    gap = cosines - sines
    return 0.125 * (gap * gap)
