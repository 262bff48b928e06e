"""Blinn-Phong lobe: density."""

from shaderlib.constants import INV_TWO_PI
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import f32
from shaderlib.lobes.half_cosine_power import half_cosine_power
from shaderlib.lobes.half_jacobian import half_jacobian
from shaderlib.lobes.half_sum import half_sum


def blinn_phong_pdf(l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Density with which blinn_phong_sample draws l, per steradian.

    l           direction to the light, in the local frame
    v           direction to the viewer, in the local frame
    exponent    p, sharpness of the lobe
    returns     (p + 1) / (2 pi) |n.h|^p / (4 |v.h|); integrates to 1 over the sphere, below the horizon
                included
    degenerate  l = -v: 0, see half_jacobian
    form        half_cosine_power and half_jacobian, from half_sum
    source      density of the half vector: Blinn 1977, normalised; change of variables: Walter 2005
    """
    g = half_sum(l, v)
    return (exponent + 1.0) * INV_TWO_PI * half_cosine_power(g, exponent) * half_jacobian(g)
