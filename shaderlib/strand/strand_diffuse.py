"""Diffuse reflection of a strand."""

from shaderlib.direction.sin_angle import sin_angle
from shaderlib.domains import Direction
from shaderlib.lang import f32


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
