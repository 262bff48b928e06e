"""Everything that the strand formulas need to know about a light and a viewer."""

from shaderlib.direction.sin_angle import sin_angle
from shaderlib.domains import Cosine, CosineDefect, Direction, UnitInterval
from shaderlib.lang import dot, struct


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
