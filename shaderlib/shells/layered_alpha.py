"""Opacity of several layers."""

from typing import Annotated

from shaderlib.constants import ONE_BELOW
from shaderlib.domains import UnitInterval
from shaderlib.lang import Interval, f32, helper, min
from shaderlib.numeric.log_one_minus import log_one_minus
from shaderlib.numeric.one_minus_exp_neg import one_minus_exp_neg


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
