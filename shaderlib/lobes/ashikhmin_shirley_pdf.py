"""Ashikhmin-Shirley lobe: density."""

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import f32
from shaderlib.lobes.ashikhmin_shirley_power import ashikhmin_shirley_power
from shaderlib.lobes.half_jacobian import half_jacobian
from shaderlib.lobes.half_sum import half_sum


def ashikhmin_shirley_pdf(l: Direction, v: Direction, exponent_x: Exponent, exponent_y: Exponent) -> f32:
    """Density with which ashikhmin_shirley_sample draws l, per steradian.

    l           direction to the light, in the local frame
    v           direction to the viewer, in the local frame
    exponent_x  sharpness across the tangent direction
    exponent_y  sharpness across the bitangent direction
    returns     density of the half vector over 4 |v.h|; integrates to 1 over the sphere, below the horizon
                included
    degenerate  l = -v: 0, see half_jacobian
    form        ashikhmin_shirley_power and half_jacobian, from half_sum
    source      Ashikhmin and Shirley 2000, An Anisotropic Phong BRDF Model
    """
    g = half_sum(l, v)
    return ashikhmin_shirley_power(g, exponent_x, exponent_y) * half_jacobian(g)
