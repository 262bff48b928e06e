"""GGX lobe: density."""

from shaderlib.domains import Direction
from shaderlib.lang import f32
from shaderlib.lobes.domains import Roughness
from shaderlib.lobes.ggx_distribution import ggx_distribution
from shaderlib.lobes.ggx_visible_area import ggx_visible_area
from shaderlib.lobes.half_sum import half_sum


def ggx_pdf(l: Direction, v: Direction, alpha_x: Roughness, alpha_y: Roughness) -> f32:
    """Density with which ggx_sample draws l, per steradian.

    l           direction to the light, in the local frame
    v           direction to the viewer, in the local frame
    alpha_x     width along the tangent
    alpha_y     width along the bitangent
    returns     D / (2 (v.z + S(v))), S = ggx_stretch, 0 where l + v points down; integrates to 1 over the
                sphere, below the horizon included, and for every v
    degenerate  l = -v: 0
    form        density G1 D max(v.h, 0) / v.z of the visible normals over 4 v.h; both v.h and v.z cancel
    source      Heitz 2018, Sampling the GGX Distribution of Visible Normals
    """
    g = half_sum(l, v)
    pdf = 0.5 * ggx_distribution(g, alpha_x, alpha_y) / ggx_visible_area(v, alpha_x, alpha_y)
    return pdf if g.z > 0.0 else 0.0
