"""Power with a defined value for every base."""

from typing import Annotated

from shaderlib.constants import EXP_LIMIT, SMALLEST_NORMAL
from shaderlib.lang import Interval, clamp, exp, exp2, f32, log, log2, max, variant
from shaderlib.numeric.atanh_series import atanh_series

# EXP_LIMIT / log(2), rounded down: the same range for powers of two.
EXP2_LIMIT = 115.0


def safe_pow(
    x: Annotated[f32, Interval(-1.0, 16.0)], y: Annotated[f32, Interval(-28.0, 1.0e5, scale="log")]
) -> f32:
    """Power x^y that is 0 for negative bases and 1 for exponent 0.

    x           base
    y           exponent
    returns     x^y between e^-80 = 1.8e-35 and e^80 = 5.5e34, where it saturates
    degenerate  y = 0: 1, whatever x is; otherwise x <= 0: 0
    form        exp(y log x) with log x = 2 atanh((x - 1) / (x + 1)) for x in [1/2, 2]: x - 1 is exact there,
                and the error of the logarithm, which y multiplies, is relative. The built-in log is promised
                to 2^-21 absolute near 1: pow(1, 1e4) may be 0.9967 on a conforming driver
    source      elementary; series: atanh_series
    """
    core = clamp(x, 0.5, 2.0)
    z = (core - 1.0) / (core + 1.0)
    log_near = 2.0 * z * atanh_series(z * z)
    log_far = log(max(x, SMALLEST_NORMAL))
    log_x = log_near if x >= 0.5 and x <= 2.0 else log_far
    positive = exp(clamp(y * log_x, -EXP_LIMIT, EXP_LIMIT))
    bounded = positive if x > 0.0 else 0.0
    return 1.0 if y == 0.0 else bounded


@variant("safe_pow")
def safe_pow_exp2(
    x: Annotated[f32, Interval(-1.0, 16.0)], y: Annotated[f32, Interval(-28.0, 1.0e5, scale="log")]
) -> f32:
    """Power x^y by the built-in logarithm: cheaper, with an error that grows with the exponent.

    x           base
    y           exponent
    returns     x^y between 2^-115 = 2.4e-35 and 2^115 = 4.2e34, where it saturates
    degenerate  y = 0: 1, whatever x is; otherwise x <= 0: 0
    form        exp2(y log2 x), as hardware computes pow, with both special cases decided beforehand: the
                built-in pow is undefined for x < 0 and unbounded at x = 0. Near x = 1 the logarithm is
                promised to 2^-21 absolute only, so the result errs by about 3.3e-7 y
    source      elementary
    """
    positive = exp2(clamp(y * log2(max(x, SMALLEST_NORMAL)), -EXP2_LIMIT, EXP2_LIMIT))
    bounded = positive if x > 0.0 else 0.0
    return 1.0 if y == 0.0 else bounded


@variant("safe_pow")
def safe_pow_near_one(
    x: Annotated[f32, Interval(0.5, 2.0)], y: Annotated[f32, Interval(-28.0, 1.0e5, scale="log")]
) -> f32:
    """Power x^y for bases from 1/2 to 2: as accurate as safe_pow, without a logarithm.

    x           base, in [0.5, 2]
    y           exponent
    returns     x^y between e^-80 = 1.8e-35 and e^80 = 5.5e34, where it saturates
    degenerate  y = 0: 1
    form        the part of safe_pow around 1: exp(y 2 atanh((x - 1) / (x + 1)))
    source      elementary; series: atanh_series
    """
    z = (x - 1.0) / (x + 1.0)
    return exp(clamp(2.0 * y * z * atanh_series(z * z), -EXP_LIMIT, EXP_LIMIT))
