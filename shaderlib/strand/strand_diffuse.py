"""Diffuse reflection of a strand."""

from shaderlib.direction.sin_angle import sin_angle, sin_angle_cosine, sin_angle_cross, sin_angle_half
from shaderlib.domains import Direction
from shaderlib.lang import f32, variant


def strand_diffuse(t: Direction, l: Direction) -> f32:
    """Diffuse factor of a thin cylinder: the sine of the angle between strand and light.

    t        strand tangent, root to tip
    l        direction to the light
    returns  sin(t, l), in [0, 1] up to rounding; multiply by the diffuse colour
    form     sin_angle. The lecture's first form divides by the length of l_N once too often, which makes it 1
             for every light
    source   Kajiya and Kay 1989, diffuse component; Banks 1994; lecture VGP352 week 6, corrected
    """
    return sin_angle(t, l)


@variant("strand_diffuse")
def strand_diffuse_half(t: Direction, l: Direction) -> f32:
    """Diffuse factor of a thin cylinder by half angles: one root, good to 1e-4 rad.

    t        strand tangent, root to tip
    l        direction to the light
    returns  sin(t, l), in [0, 1] up to rounding; multiply by the diffuse colour
    form     sin_angle_half
    source   Kajiya and Kay 1989, diffuse component; sin_angle_half
    """
    return sin_angle_half(t, l)


@variant("strand_diffuse")
def strand_diffuse_cross(t: Direction, l: Direction) -> f32:
    """Diffuse factor of a thin cylinder by the cross product: an absolute error of 1e-7.

    t        strand tangent, root to tip
    l        direction to the light
    returns  sin(t, l), in [0, 1] up to rounding; multiply by the diffuse colour
    form     sin_angle_cross
    source   Kajiya and Kay 1989, diffuse component; sin_angle_cross
    """
    return sin_angle_cross(t, l)


@variant("strand_diffuse")
def strand_diffuse_cosine(t: Direction, l: Direction) -> f32:
    """Diffuse factor of a thin cylinder by the cosine: up to 9e-4 off along the strand.

    t        strand tangent, root to tip
    l        direction to the light
    returns  sin(t, l), in [0, 1] up to rounding; multiply by the diffuse colour
    form     sin_angle_cosine
    source   Kajiya and Kay 1989, diffuse component; sin_angle_cosine
    """
    return sin_angle_cosine(t, l)
