"""Density of the half vectors that the satin sampler draws."""

from typing import Annotated

from shaderlib.constants import EXP_LIMIT, TINY_SQUARE
from shaderlib.domains import Exponent
from shaderlib.lang import Interval, abs, exp, f32, helper, max, min, sqrt, vec3
from shaderlib.lobes.arc_normal import arc_normal
from shaderlib.lobes.domains import Spread
from shaderlib.lobes.log_cosine_squared import log_cosine_squared
from shaderlib.numeric.one_minus_exp_neg import one_minus_exp_neg

# Replaces squares of 0: far below any that distinct directions have, and still exact in the quotients. The
# density has a pole at h = +-x for exponents below 1; this is where it ends.
SMALLEST_SHARE = 1.0e-24
# 1 - c^m is at least half of h.x^2, and h.x^2 / (1 - c^m) at most 2.
SMALLEST_BELL = 2.5e-25
LARGEST_QUOTIENT = 2.0


@helper
def satin_facet_density(g: Annotated[vec3, Interval(-2.0, 2.0)], spread: Spread, exponent: Exponent) -> f32:
    """Density per steradian of half vectors on a row of cylinders along x.

    g         half_sum of l and v; h = g / |g|, turned up
    spread    half angle of each arc, in radians
    exponent  p, sharpness of the facets
    returns   m c^(p - 1) |h.x| / (8 spread sqrt(1 - c^m)) where h lies over the arc, else 0; m = p + 1,
              c = sqrt(1 - h.x^2)
    form      h.x^2 / (1 - c^m) is a quotient of two quantities that vanish together: 2 / m at h.x = 0.
              Whether h lies over the arc is a comparison of products, without an angle
    source    derived for this library
    """
    edge = arc_normal(spread)
    across = g.y * g.y + g.z * g.z
    along = g.x * g.x
    k = 1.0 / max(across + along, TINY_SQUARE)
    sine_squared = max(along * k, SMALLEST_SHARE)
    decay = max(-log_cosine_squared(sine_squared, max(across * k, SMALLEST_SHARE)), SMALLEST_SHARE)
    m = exponent + 1.0
    bell = max(one_minus_exp_neg(0.5 * m * decay), SMALLEST_BELL)
    quotient = min(sine_squared / bell, LARGEST_QUOTIENT)
    power = exp(max(0.5 * (1.0 - exponent) * decay, -EXP_LIMIT))
    density = 0.125 * m * power * sqrt(quotient) / spread
    return density if abs(g.y) * edge.x < abs(g.z) * edge.y else 0.0
