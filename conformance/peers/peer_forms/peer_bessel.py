"""The Bessel function of longitudinal hair scattering as renderers write it."""

from typing import Annotated

from shaderlib.constants import TWO_PI
from shaderlib.lang import Interval, abs, exp, f32, helper, log, max, min, variant

# Where the series gives way to the asymptotic form.
SWITCH = 12.0


@helper
def peer_bessel_i0(x: Annotated[f32, Interval(0.0, 12.0)]) -> f32:
    """Modified Bessel function of order zero by the first ten terms of its power series.

    x        in [0, 12]; the series is 2 percent low at 12
    returns  I0(x)
    form     sum of (x^2 / 4)^i / (i!)^2 for i below 10
    source   Abramowitz and Stegun 1964, 9.6.12, cut off as in pbrt-v4
    """
    q = 0.25 * x * x
    tail = 1.0 + q / 49.0 * (1.0 + q / 64.0 * (1.0 + q / 81.0))
    middle = 1.0 + q / 16.0 * (1.0 + q / 25.0 * (1.0 + q / 36.0 * tail))
    return 1.0 + q * (1.0 + q / 4.0 * (1.0 + q / 9.0 * middle))


@variant("bessel_i0e")
def peer_bessel_i0e_log(x: Annotated[f32, Interval(-1.0e5, 1.0e5)]) -> f32:
    """Scaled modified Bessel function through its logarithm, as pbrt-v4, Mitsuba and Cycles form it.

    x        any sign
    returns  exp(log I0(|x|) - |x|)
    form     log of ten terms of the series up to 12; beyond, x + (-log(2 pi) + log(1 / x) + 1 / (8 x)) / 2,
             where 1 / (8 x) belongs outside the bracket. x is added and taken off again
    source   the formula of LogI0 in pbrt-v4, written anew
    """
    m = abs(x)
    series = log(peer_bessel_i0(min(m, SWITCH)))
    large = max(m, SWITCH)
    asymptotic = large + 0.5 * (-log(TWO_PI) + log(1.0 / large) + 1.0 / (8.0 * large))
    return exp((asymptotic if m > SWITCH else series) - m)
