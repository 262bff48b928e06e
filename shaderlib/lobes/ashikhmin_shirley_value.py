"""Ashikhmin-Shirley lobe: value."""

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import f32, length, max
from shaderlib.lobes.ashikhmin_shirley_power import ashikhmin_shirley_power
from shaderlib.lobes.half_sum import half_sum

# Smallest product of |l + v| and a cosine divided by; reached only where both cosines are below 1e-10.
SMALLEST_DIVISOR = 1.0e-20


def ashikhmin_shirley_value(l: Direction, v: Direction, exponent_x: Exponent, exponent_y: Exponent) -> f32:
    """Reflectance of the Ashikhmin-Shirley highlight per steradian, without the cosine, Fresnel factor 1.

    l           direction to the light, in the local frame
    v           direction to the viewer, in the local frame
    exponent_x  sharpness across the tangent direction
    exponent_y  sharpness across the bitangent direction
    returns     sqrt((exponent_x + 1) (exponent_y + 1)) / (8 pi) (n.h)^E / ((v.h) max(l.z, v.z)), E as in
                ashikhmin_shirley_power; 0 for l.z <= 0 or v.z <= 0. Reciprocal; albedo below 1, only 0.14 at
                normal incidence for exponents 0. The diffuse part of the paper is not included
    form        v.h = |l + v| / 2 for unit vectors
    source      Ashikhmin and Shirley 2000, An Anisotropic Phong BRDF Model
    """
    g = half_sum(l, v)
    lobe = ashikhmin_shirley_power(g, exponent_x, exponent_y)
    value = 0.5 * lobe / max(length(g) * max(l.z, v.z), SMALLEST_DIVISOR)
    return value if l.z > 0.0 and v.z > 0.0 else 0.0
