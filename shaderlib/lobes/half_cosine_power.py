"""Power of the cosine between normal and half vector."""

from typing import Annotated

from shaderlib.constants import TINY_SQUARE
from shaderlib.domains import Exponent
from shaderlib.lang import Interval, f32, helper, max, vec3
from shaderlib.lobes.cosine_power import cosine_power


@helper
def half_cosine_power(g: Annotated[vec3, Interval(-2.0, 2.0)], exponent: Exponent) -> f32:
    """Power |h.z|^exponent of the half vector h = g / |g|.

    g         half_sum of l and v
    exponent  exponent, in [0, 1e5]
    returns   in [0, 1] up to rounding; the same for h and -h
    form      squares of sine and cosine from the components of g, so that neither h -> n nor h -> horizon
              cancels; g itself is exact where it is small
    source    elementary
    """
    planar = g.x * g.x + g.y * g.y
    upright = g.z * g.z
    k = 1.0 / max(planar + upright, TINY_SQUARE)
    return cosine_power(planar * k, upright * k, exponent)
