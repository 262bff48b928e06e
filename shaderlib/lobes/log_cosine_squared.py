"""Logarithm of a squared cosine."""

from shaderlib.constants import SMALLEST_NORMAL
from shaderlib.domains import UnitInterval
from shaderlib.lang import f32, helper, log, max, min
from shaderlib.numeric.atanh_series import atanh_series


@helper
def log_cosine_squared(sine_squared: UnitInterval, cosine_squared: UnitInterval) -> f32:
    """Natural logarithm of a squared cosine, with flat relative error as the cosine tends to 1 and to 0.

    sine_squared    1 - c^2, computed directly
    cosine_squared  c^2, computed directly
    returns         log(c^2), in [-87.3, 0] up to rounding
    form            from the smaller of the two squares: -2 atanh(s / (2 - s)) of s = sine_squared below 1/2,
                    log(cosine_squared), which is promised relatively there, above
    source          identity log(1 - s) = -2 atanh(s / (2 - s))
    """
    core = min(sine_squared, 0.5)
    z = core / (2.0 - core)
    log_near = -2.0 * z * atanh_series(z * z)
    log_far = log(max(cosine_squared, SMALLEST_NORMAL))
    return log_near if sine_squared < 0.5 else log_far
