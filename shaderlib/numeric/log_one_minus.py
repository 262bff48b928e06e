"""Logarithm of one minus a small number."""

from typing import Annotated

from shaderlib.constants import SMALLEST_NORMAL
from shaderlib.lang import Interval, f32, log, max, min, variant
from shaderlib.numeric.atanh_series import atanh_series

# Minimax in the relative error of z (1 + THIN_2 z^2) against atanh z for z <= 1/3: 4.7e-4.
THIN_2 = 0.35312897  # 3eb4cd52


def log_one_minus(q: Annotated[f32, Interval(0.0, 0.99999994, scale="log")]) -> f32:
    """Natural logarithm of 1 - q, accurate as q -> 0.

    q        in [0, 1); the largest float32 below 1 gives -16.64
    returns  log(1 - q), at most 0, with flat relative error
    form     -2 atanh(q / (2 - q)) below 1/2: nothing cancels. Above, 1 - q is exact and log of a value below
             1/2 is promised relatively. log(1 - q) alone is useless below q = 1e-7, where 1 - q rounds to 1
    source   identity log(1 - q) = -2 atanh(q / (2 - q)); series: atanh_series
    """
    core = min(q, 0.5)
    z = core / (2.0 - core)
    log_near = -2.0 * z * atanh_series(z * z)
    log_far = log(max(1.0 - q, SMALLEST_NORMAL))
    return log_near if q < 0.5 else log_far


@variant("log_one_minus")
def log_one_minus_direct(q: Annotated[f32, Interval(0.0, 0.99999994)]) -> f32:
    """Natural logarithm of 1 - q as written: a small absolute error, no relative accuracy as q -> 0.

    q        in [0, 1)
    returns  log(1 - q)
    form     1 - q is rounded before the logarithm sees it, and log is promised to 2^-21 absolute near 1
    source   elementary
    """
    return log(max(1.0 - q, SMALLEST_NORMAL))


@variant("log_one_minus")
def log_one_minus_thin(q: Annotated[f32, Interval(0.0, 0.5, scale="log")]) -> f32:
    """Natural logarithm of 1 - q for q up to 1/2 by two terms: no logarithm, 0.05 percent.

    q        in [0, 0.5]
    returns  log(1 - q) to 4.7e-4 relative
    form     -2 atanh(z) with z = q / (2 - q) <= 1/3, in which the series is odd: its second term, fitted,
             stands for all others
    source   log(1 - q) = -2 atanh(q / (2 - q)); fitted for this library
    """
    z = q / (2.0 - q)
    return -2.0 * z * (1.0 + THIN_2 * (z * z))
