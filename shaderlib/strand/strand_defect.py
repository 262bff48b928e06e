"""How far a strand is from mirroring the light to the viewer."""

from shaderlib.direction.sin_angle import sin_angle, sin_angle_half
from shaderlib.domains import Direction
from shaderlib.lang import dot, f32, helper


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
    """Defect 1 - strand_cosine of a strand, with sines by half angles.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  ((sin_l - sin_v)^2 + (t.(l + v))^2) / 2, in [0, 2] up to rounding
    form     strand_defect; the sines enter as a difference, so their absolute error counts and the cheaper
             ones do
    source   identity derived for this library
    """
    across = sin_angle_half(t, l) - sin_angle_half(t, v)
    along = dot(t, l + v)
    return 0.5 * (across * across + along * along)
