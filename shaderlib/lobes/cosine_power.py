"""Power of a cosine that is known by its square and by the square of its sine."""

from shaderlib.constants import EXP_LIMIT
from shaderlib.domains import Exponent, UnitInterval
from shaderlib.lang import clamp, exp, f32, helper
from shaderlib.lobes.log_cosine_squared import log_cosine_squared


@helper
def cosine_power(sine_squared: UnitInterval, cosine_squared: UnitInterval, exponent: Exponent) -> f32:
    """Power c^exponent of a cosine c >= 0, accurate as c -> 1 and as c -> 0.

    sine_squared    1 - c^2, computed directly
    cosine_squared  c^2, computed directly
    exponent        exponent, in [0, 1e5]
    returns         c^exponent, in [0, 1] up to rounding; not below e^-80 = 1.8e-35
    degenerate      exponent = 0: 1
    form            exp(exponent log(c^2) / 2), by log_cosine_squared. A logarithm that rounding leaves above
                    0 counts as 0: times the exponent it might overflow
    source          elementary
    """
    log_power = 0.5 * exponent * log_cosine_squared(sine_squared, cosine_squared)
    return exp(clamp(log_power, -EXP_LIMIT, 0.0))
