"""Cosine between the viewer and the best mirror direction of a strand."""

from shaderlib.direction.sin_angle import sin_angle
from shaderlib.domains import Direction
from shaderlib.lang import dot, f32, max, printed, sqrt, variant
from shaderlib.strand.strand_defect import strand_defect, strand_defect_half


def strand_cosine(t: Direction, l: Direction, v: Direction) -> f32:
    """Largest cosine between v and a mirror direction of l, over all unit normals orthogonal to the strand.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  sin_l sin_v - cos_l cos_v, in [-1, 1] up to rounding; 1 on the cone t.v = -t.l
    form     1 - q with the defect q of strand_angles; for high powers use strand_specular, which never forms
             this difference
    source   Banks 1994; the lecture's sign corrected: l and v both point away from the strand
    """
    return 1.0 - strand_defect(t, l, v)


@variant("strand_cosine")
def strand_cosine_direct(t: Direction, l: Direction, v: Direction) -> f32:
    """Strand cosine with sines taken from the cosines: the obvious form, with one root.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  sin_l sin_v - cos_l cos_v, in [-1, 1] up to rounding
    form     sqrt((1 - cos_l^2) (1 - cos_v^2)) - cos_l cos_v; cancels where l or v is along the strand
    source   Banks 1994; Kajiya and Kay 1989
    """
    cos_l = dot(t, l)
    cos_v = dot(t, v)
    sines = sqrt(max((1.0 - cos_l * cos_l) * (1.0 - cos_v * cos_v), 0.0))
    return sines - cos_l * cos_v


@variant("strand_cosine")
def strand_cosine_half(t: Direction, l: Direction, v: Direction) -> f32:
    """Strand cosine by half angles, from four squared lengths.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  sin_l sin_v - cos_l cos_v, in [-1, 1] up to rounding; 1 on the cone t.v = -t.l
    form     1 - strand_defect_half: as good as strand_cosine at every angle, for two thirds of the work
    source   double-angle formula; derived for this library
    """
    return 1.0 - strand_defect_half(t, l, v)


@printed("strand_cosine")
def strand_cosine_banks_printed(t: Direction, l: Direction, v: Direction) -> f32:
    """Strand cosine as the lecture prints it for Banks: the exact negative of the right value.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  cos_l cos_v - sin_l sin_v, in [-1, 1] up to rounding; -1 on the cone of the highlight
    form     its r is l_T - l_N, opposite to the mirror direction l_N - l_T; an even exponent hides the sign
    source   lecture VGP352 week 6, Banks BRDF, to the letter
    """
    return dot(t, l) * dot(t, v) - sin_angle(t, l) * sin_angle(t, v)


@printed("strand_cosine")
def strand_cosine_kajiya_printed(t: Direction, l: Direction, v: Direction) -> f32:
    """Strand cosine as the lecture prints it for Kajiya and Kay: right only where l or v points inward.

    t        strand tangent, root to tip
    l        direction to the light
    v        direction to the viewer
    returns  cos_l cos_v + sin_l sin_v, in [-1, 1] up to rounding; 1 on the cone t.v = t.l
    form     equals strand_cosine(t, l, -v): the highlight lies on the wrong cone unless t is orthogonal to l
    source   lecture VGP352 week 6, Goldman's specular term, to the letter
    """
    return dot(t, l) * dot(t, v) + sin_angle(t, l) * sin_angle(t, v)
