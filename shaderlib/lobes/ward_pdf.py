"""Ward lobe: density."""

from shaderlib.constants import EXP_LIMIT, INV_TWO_PI, TINY_SQUARE
from shaderlib.domains import Direction
from shaderlib.lang import abs, exp, f32, max
from shaderlib.lobes.domains import Roughness
from shaderlib.lobes.half_sum import half_sum

# Smallest |g.z| divided by: its square is an ordinary float.
SMALLEST_HEIGHT = 1.0e-18


def ward_pdf(l: Direction, v: Direction, alpha_x: Roughness, alpha_y: Roughness) -> f32:
    """Density with which ward_sample draws l, per steradian.

    l           direction to the light, in the local frame
    v           direction to the viewer, in the local frame
    alpha_x     root mean square slope along the tangent
    alpha_y     root mean square slope along the bitangent
    returns     exp(-e) / (4 pi alpha_x alpha_y |v.h| |n.h|^3), e as in ward_value; 0 for e > 80. Integrates
                to 1 over the sphere, below the horizon included
    degenerate  l = -v: 0. The half vector is undefined there, and the sampler never draws it
    form        exp(-e) (1 + t^2) / (2 pi alpha_x alpha_y |g.z|), g = l + v, t the slope of g: v.h = |g| / 2
                removes both h and the dot product
    source      Walter 2005, Notes on the Ward BRDF; form derived for this library
    """
    g = half_sum(l, v)
    x = g.x / alpha_x
    y = g.y / alpha_y
    stretched = x * x + y * y
    planar = g.x * g.x + g.y * g.y
    upright = g.z * g.z
    # The second operand keeps the quotients below 80 where the lobe has ended.
    k = 1.0 / max(max(upright, stretched / EXP_LIMIT), TINY_SQUARE)
    bell = exp(-stretched * k) * (1.0 + planar * k)
    pdf = bell * (INV_TWO_PI / (alpha_x * alpha_y)) / max(abs(g.z), SMALLEST_HEIGHT)
    return pdf if stretched < EXP_LIMIT * upright else 0.0
