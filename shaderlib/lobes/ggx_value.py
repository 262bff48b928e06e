"""GGX lobe: value."""

from shaderlib.domains import Direction
from shaderlib.lang import f32, max
from shaderlib.lobes.domains import Roughness
from shaderlib.lobes.ggx_distribution import ggx_distribution
from shaderlib.lobes.ggx_stretch import ggx_stretch
from shaderlib.lobes.half_sum import half_sum

# Smallest divisor; with alpha >= 1e-4 it is reached only where both cosines are below 1e-16.
SMALLEST_DIVISOR = 1.0e-20


def ggx_value(l: Direction, v: Direction, alpha_x: Roughness, alpha_y: Roughness) -> f32:
    """Reflectance of the anisotropic GGX lobe per steradian, without the cosine, Fresnel factor 1.

    l        direction to the light, in the local frame
    v        direction to the viewer, in the local frame
    alpha_x  width along the tangent (the square of what artists call roughness)
    alpha_y  width along the bitangent
    returns  D G2 / (4 l.z v.z) with height-correlated masking; 0 for l.z <= 0 or v.z <= 0. Reciprocal; albedo
             at most 1, 0.31 at normal incidence for widths 1, because light between facets is lost
    form     D / (2 (l.z S(v) + v.z S(l))), S = ggx_stretch: the cosines of masking and denominator cancel, so
             nothing is divided by l.z or v.z alone
    source   Walter, Marschner, Li and Torrance 2007; Heitz 2014, Understanding the Masking-Shadowing Function
             in Microfacet-Based BRDFs
    """
    mask = l.z * ggx_stretch(v, alpha_x, alpha_y) + v.z * ggx_stretch(l, alpha_x, alpha_y)
    value = 0.5 * ggx_distribution(half_sum(l, v), alpha_x, alpha_y) / max(mask, SMALLEST_DIVISOR)
    return value if l.z > 0.0 and v.z > 0.0 else 0.0
