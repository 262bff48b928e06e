"""Polynomial for (1 - e^-x) / x near zero."""

from typing import Annotated

from shaderlib.lang import Interval, f32, helper

# Minimax in the relative error of x * series(x) on [0, 0.7]; 1.466e-7 over all 95,630,132 floats of
# [2^-12, 0.7] with every operation rounded.
EXPREL_1 = -0.499999315  # beffffe9
EXPREL_2 = 0.166653007  # 3e2aa716
EXPREL_3 = -0.0415772162  # bd2a4cdf
EXPREL_4 = 0.00807364937  # 3c044757
EXPREL_5 = -0.00103592372  # ba87c7d5


@helper
def exprel_series(x: Annotated[f32, Interval(0.0, 0.7)]) -> f32:
    """Polynomial for (1 - e^-x) / x.

    x        in [0, 0.7]
    returns  (1 - e^-x) / x, in [0.719, 1]; 1 at x = 0
    form     fifth degree; up to 0.7 it is both more accurate and cheaper than a Taylor series to 0.3
    source   minimax polynomial fitted for this library
    """
    return 1.0 + x * (EXPREL_1 + x * (EXPREL_2 + x * (EXPREL_3 + x * (EXPREL_4 + x * EXPREL_5))))
