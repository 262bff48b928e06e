"""Length of a direction in the space where a GGX surface is a hemisphere."""

from shaderlib.domains import Direction
from shaderlib.lang import f32, helper, length, vec3
from shaderlib.lobes.domains import Roughness


@helper
def ggx_stretch(w: Direction, alpha_x: Roughness, alpha_y: Roughness) -> f32:
    """Length of (alpha_x w.x, alpha_y w.y, w.z), from which all masking terms follow.

    w        direction, in the local frame
    alpha_x  width along the tangent
    alpha_y  width along the bitangent
    returns  at least min(alpha_x, alpha_y) and at least |w.z|; the masking function is
             G1(w) = 2 w.z / (w.z + stretch)
    form     no division by w.z, no tangent
    source   Heitz 2014, Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs
    """
    return length(vec3(alpha_x * w.x, alpha_y * w.y, w.z))
