"""Blinn-Phong lobe: value."""

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import f32
from shaderlib.lobes.blinn_phong_scale import blinn_phong_scale
from shaderlib.lobes.half_cosine_power import half_cosine_power
from shaderlib.lobes.half_sum import half_sum


def blinn_phong_value(l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Reflectance of the Blinn-Phong lobe per steradian, without the cosine, Fresnel factor 1.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   blinn_phong_scale(p) (n.h)^p; 0 for l.z <= 0 or v.z <= 0. Reciprocal; albedo exactly 1 at normal
              incidence, falling toward grazing
    form      half_cosine_power, from the squares of half_sum
    source    Blinn 1977, Models of Light Reflection for Computer Synthesized Pictures; scale: Giesen 2009
    """
    value = blinn_phong_scale(exponent) * half_cosine_power(half_sum(l, v), exponent)
    return value if l.z > 0.0 and v.z > 0.0 else 0.0
