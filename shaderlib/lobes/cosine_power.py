"""Power of a cosine that is known by its square and by the square of its sine."""

from shaderlib.constants import EXP_LIMIT, SMALLEST_NORMAL
from shaderlib.domains import Exponent, UnitInterval
from shaderlib.lang import exp, f32, helper, log, max, min
from shaderlib.numeric.atanh_series import atanh_series


@helper
def cosine_power(sine_squared: UnitInterval, cosine_squared: UnitInterval, exponent: Exponent) -> f32:
    """Power c^exponent of a cosine c >= 0, accurate as c -> 1 and as c -> 0.

    sine_squared    1 - c^2, computed directly
    cosine_squared  c^2, computed directly
    exponent        exponent, in [0, 1e5]
    returns         c^exponent, in [0, 1] up to rounding; not below e^-80 = 1.8e-35
    degenerate      exponent = 0: 1
    form            exp(exponent / 2 log(c^2)), the logarithm from the smaller of the two squares:
                    -2 atanh(s / (2 - s)) of s = sine_squared below 1/2, log(cosine_squared) above
    source          identity log(1 - s) = -2 atanh(s / (2 - s))
    """
    core = min(sine_squared, 0.5)
    z = core / (2.0 - core)
    log_near = -2.0 * z * atanh_series(z * z)
    log_far = log(max(cosine_squared, SMALLEST_NORMAL))
    log_square = log_near if sine_squared < 0.5 else log_far
    return exp(max(0.5 * exponent * log_square, -EXP_LIMIT))
