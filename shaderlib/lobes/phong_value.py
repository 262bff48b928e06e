"""Phong lobe: value."""

from shaderlib.constants import INV_TWO_PI
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import f32
from shaderlib.lobes.phong_power import phong_power


def phong_value(l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Reflectance of the modified Phong lobe per steradian, without the cosine, Fresnel factor 1.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   (p + 2) / (2 pi) max(0, l.r)^p, r the mirror direction of v; 0 for l.z <= 0, v.z <= 0 or l.r <=
              0. Reciprocal; albedo 1 at normal incidence and less elsewhere, toward v.z for large p
    form      phong_power, from the distance between l and r
    source    Lafortune and Willems 1994, Using the Modified Phong Reflectance Model for Physically Based
              Rendering
    """
    value = (exponent + 2.0) * INV_TWO_PI * phong_power(l, v, exponent)
    return value if l.z > 0.0 and v.z > 0.0 else 0.0
