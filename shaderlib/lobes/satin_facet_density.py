"""Density of the half vectors that the satin sampler draws."""

from typing import Annotated

from shaderlib.constants import TINY_SQUARE
from shaderlib.domains import Exponent
from shaderlib.lang import Interval, abs, f32, helper, inverse_sqrt, max, min, sqrt, vec3
from shaderlib.lobes.arc_normal import arc_normal
from shaderlib.lobes.cosine_power import cosine_power
from shaderlib.lobes.domains import Spread
from shaderlib.numeric.log_one_minus import log_one_minus
from shaderlib.numeric.one_minus_exp_neg import one_minus_exp_neg

# Replaces h.x^2 = 0: far below any that distinct directions have, and still exact in the quotient.
SMALLEST_DEFECT = 1.0e-24

# Largest h.x^2 and smallest 1 - h.x^2: the density has a pole at h = +-x for exponents below 1.
LARGEST_SINE_SQUARED = 0.99999994
SMALLEST_COSINE_SQUARED = 1.0e-12


@helper
def satin_facet_density(g: Annotated[vec3, Interval(-2.0, 2.0)], spread: Spread, exponent: Exponent) -> f32:
    """Density per steradian of half vectors on a row of cylinders along x.

    g         l + v, not normalised; h = g / |g|, turned up
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
    sine_squared = min(max(along * k, SMALLEST_DEFECT), LARGEST_SINE_SQUARED)
    cosine_squared = max(across * k, SMALLEST_COSINE_SQUARED)
    m = exponent + 1.0
    bell = one_minus_exp_neg(-0.5 * m * log_one_minus(sine_squared))
    power = cosine_power(sine_squared, cosine_squared, exponent) * inverse_sqrt(cosine_squared)
    density = 0.125 * m * power * sqrt(sine_squared / bell) / spread
    return density if abs(g.y) * edge.x < abs(g.z) * edge.y else 0.0
