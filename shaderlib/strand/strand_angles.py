"""Everything that the strand formulas need to know about a light and a viewer."""

from shaderlib.direction.sin_angle import sin_angle
from shaderlib.domains import Cosine, CosineDefect, Direction, UnitInterval
from shaderlib.lang import dot, max, sqrt, struct, variant


@struct
class StrandAngles:
    """Angles of light and viewer to a strand.

    cos_l   cosine of the angle between tangent and light: t.l
    cos_v   cosine of the angle between tangent and viewer: t.v
    sin_l   sine of the angle between tangent and light
    sin_v   sine of the angle between tangent and viewer
    defect  1 - strand_cosine: 0 on the cone of the highlight, 2 opposite to it
    """

    cos_l: Cosine
    cos_v: Cosine
    sin_l: UnitInterval
    sin_v: UnitInterval
    defect: CosineDefect


def strand_angles(t: Direction, l: Direction, v: Direction) -> StrandAngles:
    """Angles of a light and a viewer to a strand, computed once for diffuse and specular terms.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  cosines t.l and t.v, sines, and the defect q = 1 - (sin sin - cos cos)
    form     q = ((sin_l - sin_v)^2 + (cos_l + cos_v)^2) / 2, exact for unit vectors. On the highlight q is a
             small number with a small error; 1 - (sin sin - cos cos) would be rounding noise there
    source   Banks 1994; Kajiya and Kay 1989; identity derived for this library
    """
    cos_l = dot(t, l)
    cos_v = dot(t, v)
    sin_l = sin_angle(t, l)
    sin_v = sin_angle(t, v)
    across = sin_l - sin_v
    along = cos_l + cos_v
    return StrandAngles(cos_l, cos_v, sin_l, sin_v, 0.5 * (across * across + along * along))


@variant("strand_angles")
def strand_angles_half(t: Direction, l: Direction, v: Direction) -> StrandAngles:
    """Angles of a light and a viewer to a strand by half angles: everything from four squared lengths.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  cosines t.l and t.v, sines good to 1e-4 rad, and the defect
    form     |t - l| = 2 sin(a / 2) and |t + l| = 2 cos(a / 2) for the angle a: their product is twice the
             sine, the difference of their squares four times the cosine
    source   double-angle formulas; strand_angles
    """
    far_l = t - l
    near_l = t + l
    far_v = t - v
    near_v = t + v
    low_l = dot(far_l, far_l)
    high_l = dot(near_l, near_l)
    low_v = dot(far_v, far_v)
    high_v = dot(near_v, near_v)
    cos_l = 0.25 * (high_l - low_l)
    cos_v = 0.25 * (high_v - low_v)
    sin_l = 0.5 * sqrt(low_l * high_l)
    sin_v = 0.5 * sqrt(low_v * high_v)
    across = sin_l - sin_v
    along = cos_l + cos_v
    return StrandAngles(cos_l, cos_v, sin_l, sin_v, 0.5 * (across * across + along * along))


@variant("strand_angles")
def strand_angles_cosine(t: Direction, l: Direction, v: Direction) -> StrandAngles:
    """Angles of a light and a viewer to a strand from their cosines: for directions away from the strand.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  cosines t.l and t.v, sines up to 9e-4 off along the strand, and the defect
    form     sines as in sin_angle_cosine; the defect stays a sum of squares, and is right where they are
    source   elementary; strand_angles
    """
    cos_l = dot(t, l)
    cos_v = dot(t, v)
    sin_l = sqrt(max(1.0 - cos_l * cos_l, 0.0))
    sin_v = sqrt(max(1.0 - cos_v * cos_v, 0.0))
    across = sin_l - sin_v
    along = cos_l + cos_v
    return StrandAngles(cos_l, cos_v, sin_l, sin_v, 0.5 * (across * across + along * along))
