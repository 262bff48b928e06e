"""GGX as renderers write it that take the sine of the half vector from its cosine."""

from shaderlib.constants import INV_PI, TINY_SQUARE
from shaderlib.domains import Direction
from shaderlib.lang import clamp, dot, f32, inverse_sqrt, max, sqrt, variant
from shaderlib.lobes.domains import Roughness
from shaderlib.lobes.ggx_stretch import ggx_stretch

# Smallest divisor, as in ggx_value.
SMALLEST_DIVISOR = 1.0e-20


@variant("ggx_value")
def peer_ggx_one_minus_square(l: Direction, v: Direction, alpha_x: Roughness, alpha_y: Roughness) -> f32:
    """Reflectance of the anisotropic GGX lobe with a distribution by 1 - (n.h)^2; masking as ggx_value.

    l        direction to the light, in the local frame
    v        direction to the viewer, in the local frame
    alpha_x  width along the tangent
    alpha_y  width along the bitangent
    returns  D G2 / (4 l.z v.z); 0 for l.z <= 0 or v.z <= 0
    form     sin^2 = max(0, 1 - h.z^2), tan^2 = sin^2 / cos^2, the azimuth from h.x, h.y over sin, clamped;
             for h close to n everything is a rounding error of 1 - h.z^2
    source   the formula of TrowbridgeReitzDistribution::D in pbrt-v4, written anew
    """
    total = l + v
    h = inverse_sqrt(max(dot(total, total), TINY_SQUARE)) * total
    cos_square = max(h.z * h.z, SMALLEST_DIVISOR)
    sin_square = max(1.0 - h.z * h.z, 0.0)
    sine = max(sqrt(sin_square), SMALLEST_DIVISOR)
    along = clamp(h.x / sine, -1.0, 1.0) / alpha_x
    across = clamp(h.y / sine, -1.0, 1.0) / alpha_y
    slope = sin_square / cos_square * (along * along + across * across)
    spread = cos_square * (1.0 + slope)
    density = INV_PI / (alpha_x * alpha_y) / max(spread * spread, SMALLEST_DIVISOR)
    mask = l.z * ggx_stretch(v, alpha_x, alpha_y) + v.z * ggx_stretch(l, alpha_x, alpha_y)
    value = 0.5 * density / max(mask, SMALLEST_DIVISOR)
    return value if l.z > 0.0 and v.z > 0.0 else 0.0
