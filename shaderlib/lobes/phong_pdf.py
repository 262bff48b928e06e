"""Phong lobe: density."""

from shaderlib.constants import INV_TWO_PI
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import f32
from shaderlib.lobes.phong_power import phong_power


def phong_pdf(l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Density with which phong_sample draws l, per steradian.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   (p + 1) / (2 pi) max(0, l.r)^p; integrates to 1 over the sphere, below the horizon included
    form      phong_power, from the distance between l and r
    source    Lafortune and Willems 1994
    """
    return (exponent + 1.0) * INV_TWO_PI * phong_power(l, v, exponent)
