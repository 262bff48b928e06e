"""Inverse of the distribution of a power of a cosine."""

from typing import Annotated

from shaderlib.constants import ONE_BELOW
from shaderlib.lang import Interval, f32, helper
from shaderlib.numeric.log_one_minus import log_one_minus
from shaderlib.numeric.one_minus_exp_neg import one_minus_exp_neg


@helper
def power_defect(
    u: Annotated[f32, Interval(0.0, ONE_BELOW)],
    exponent: Annotated[f32, Interval(1.0, 100001.0, scale="log")],
) -> f32:
    """Defect q = 1 - cos of the angle that a uniform number selects from the density cos^(exponent - 1).

    u         uniform number in [0, 1); 0 is the peak
    exponent  m >= 1; the distribution of the cosine is c^m
    returns   1 - (1 - u)^(1 / m), in [0, 1); cos = 1 - q, sin = sqrt(q (2 - q))
    form      1 - e^-x of x = -log(1 - u) / m, both without cancellation: narrow lobes keep all digits, where
              sqrt(1 - cos^2) of a cosine that is nearly 1 keeps none
    source    inversion method
    """
    return one_minus_exp_neg(-log_one_minus(u) / exponent)
