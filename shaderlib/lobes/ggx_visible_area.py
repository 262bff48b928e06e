"""Area of a GGX surface that a direction sees."""

from shaderlib.domains import Direction
from shaderlib.lang import f32, helper, max
from shaderlib.lobes.domains import Roughness
from shaderlib.lobes.ggx_stretch import ggx_stretch

# Smallest area; reached only within 1e-6 rad of straight below.
SMALLEST_AREA = 1.0e-20


@helper
def ggx_visible_area(w: Direction, alpha_x: Roughness, alpha_y: Roughness) -> f32:
    """Twice the projected area of the facets that face a direction, per area of the surface.

    w        direction, in the local frame; also from below
    alpha_x  width along the tangent
    alpha_y  width along the bitangent
    returns  w.z + S(w), S = ggx_stretch; at least 1e-20
    form     for w.z < 0 as (S^2 - w.z^2) / (S - w.z), which does not cancel
    source   Heitz, Dupuy, Crassin and Dachsbacher 2015, The SGGX Microflake Distribution; Heitz 2014
    """
    s = ggx_stretch(w, alpha_x, alpha_y)
    x = alpha_x * w.x
    y = alpha_y * w.y
    below = (x * x + y * y) / (s + max(-w.z, 0.0))
    return max(w.z + s if w.z >= 0.0 else below, SMALLEST_AREA)
