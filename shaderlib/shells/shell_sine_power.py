"""Power of the sine between a hair and a direction."""

from shaderlib.constants import EXP_LIMIT, SMALLEST_NORMAL
from shaderlib.direction.doubled_cross import doubled_cross
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import dot, exp, f32, helper, log, max, min
from shaderlib.numeric.log_one_minus import log_one_minus


@helper
def shell_sine_power(n: Direction, w: Direction, p: Exponent) -> f32:
    """Power sin(n, w)^p, accurate at every angle and for every exponent.

    n           hair direction
    w           direction to the light, or half vector
    p           exponent, in [0, 1e5]
    returns     sin(n, w)^p, in [0, 1]; not below e^-80 = 1.8e-35 unless it is 0
    degenerate  w = n and w = -n, and sines below 1e-19: 0 for p > 0; p = 0: 1 everywhere
    form        exp(p / 2 log sin^2). Near the hair sin^2 comes from the cross product of sum and
                difference, with relative accuracy (1 - cos^2 has none, and sin itself would err by 3e-4);
                across the hair its logarithm is that of 1 - cos^2 with a small cosine, which large
                exponents need
    source      derived for this library
    """
    c = dot(n, w)
    across = doubled_cross(n, w)
    sine_square = 0.25 * dot(across, across)
    log_across = log_one_minus(min(c * c, 0.5))
    log_along = log(max(sine_square, SMALLEST_NORMAL))
    log_square = log_along if sine_square < 0.5 else log_across
    power = exp(max(0.5 * p * log_square, -EXP_LIMIT))
    return power if sine_square > 0.0 or p <= 0.0 else 0.0
