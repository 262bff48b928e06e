"""Opacity of several layers."""

from typing import Annotated

from shaderlib.constants import EXP_LIMIT, ONE_BELOW, SMALLEST_NORMAL
from shaderlib.domains import UnitInterval
from shaderlib.lang import Interval, exp, f32, helper, log, max, min
from shaderlib.numeric.log_one_minus import log_one_minus, log_one_minus_thin
from shaderlib.numeric.one_minus_exp_neg import one_minus_exp_neg, one_minus_exp_neg_doubling_short


@helper
def layered_alpha(alpha: UnitInterval, layers: Annotated[f32, Interval(1.0e-4, 1.0e5, scale="log")]) -> f32:
    """Opacity of a number of equal layers, or of a share of one.

    alpha       opacity of one layer, in [0, 1]
    layers      number of layers, in [1e-4, 1e5]
    returns     1 - (1 - alpha)^layers, in [0, 1]
    degenerate  alpha = 0: 0; alpha = 1: 1
    form        one_minus_exp_neg of an optical depth: relative accuracy for thin layers, which the obvious
                form loses twice, in 1 - alpha and in 1 - power
    source      Beer-Lambert law
    """
    depth = -layers * log_one_minus(min(alpha, ONE_BELOW))
    return one_minus_exp_neg(depth) if alpha < 1.0 else 1.0


@helper
def layered_alpha_direct(
    alpha: UnitInterval, layers: Annotated[f32, Interval(1.0e-4, 1.0e5, scale="log")]
) -> f32:
    """Opacity of a number of equal layers, to a small absolute error.

    alpha       opacity of one layer, in [0, 1]
    layers      number of layers, in [1e-4, 1e5]
    returns     1 - (1 - alpha)^layers, in [0, 1] up to rounding
    degenerate  alpha = 0: 0 up to rounding; alpha = 1: 1
    form        as written, the power by log and exp
    source      Beer-Lambert law
    """
    left = exp(max(layers * log(max(1.0 - alpha, SMALLEST_NORMAL)), -EXP_LIMIT))
    return 1.0 - left if alpha < 1.0 else 1.0


@helper
def layered_alpha_thin(
    alpha: Annotated[f32, Interval(0.0, 0.5)], layers: Annotated[f32, Interval(1.0e-4, 1.0e5, scale="log")]
) -> f32:
    """Opacity of a number of equal layers that are at most half opaque, to 0.1 percent.

    alpha       opacity of one layer, in [0, 0.5]
    layers      number of layers, in [1e-4, 1e5]
    returns     1 - (1 - alpha)^layers, in [0, 1]
    degenerate  alpha = 0: 0
    form        log_one_minus_thin and one_minus_exp_neg_doubling_short: no transcendental function
    source      Beer-Lambert law; fitted for this library
    """
    return one_minus_exp_neg_doubling_short(-layers * log_one_minus_thin(alpha))
