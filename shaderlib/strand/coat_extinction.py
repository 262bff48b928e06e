"""Extinction of a coat from its density."""

from typing import Annotated

from shaderlib.constants import COAT_LIMIT, ONE_BELOW, SMALLEST_NORMAL
from shaderlib.domains import UnitInterval
from shaderlib.lang import Interval, f32, log, max, min, variant
from shaderlib.numeric.log_one_minus import log_one_minus, log_one_minus_thin


def coat_extinction(rho: UnitInterval) -> f32:
    """Extinction coefficient of a coat that absorbs the fraction rho per unit length.

    rho         fraction of light lost along a path of length 1, in [0, 1]; Banks uses 0.02
    returns     -log(1 - rho) per unit length, at least 0
    degenerate  rho = 1: 1e18, opaque after any path longer than 1e-16
    form        log_one_minus; (1 - rho)^path is then coat_transmittance(extinction, path). Compute it once on
                the host: rounding 1 - rho costs a relative error that grows with the path
    source      Banks 1994, vector field shadowing; lecture VGP352 week 6
    """
    inside = -log_one_minus(min(rho, ONE_BELOW))
    return inside if rho < 1.0 else COAT_LIMIT


@variant("coat_extinction")
def coat_extinction_direct(rho: UnitInterval) -> f32:
    """Extinction coefficient of a coat, as written: a small absolute error.

    rho         fraction of light lost along a path of length 1, in [0, 1]
    returns     -log(1 - rho) per unit length
    degenerate  rho = 1: 1e18
    form        -log(1 - rho): no relative accuracy for thin coats; 6e-7 absolute up to rho = 1/2
    source      Banks 1994, vector field shadowing
    """
    inside = -log(max(1.0 - rho, SMALLEST_NORMAL))
    return inside if rho < 1.0 else COAT_LIMIT


@variant("coat_extinction")
def coat_extinction_thin(rho: Annotated[f32, Interval(0.0, 0.5)]) -> f32:
    """Extinction coefficient of a coat that loses at most half the light per unit length, to 0.05 percent.

    rho      fraction of light lost along a path of length 1, in [0, 0.5]
    returns  -log(1 - rho) per unit length
    form     log_one_minus_thin: no logarithm
    source   Banks 1994, vector field shadowing; fitted for this library
    """
    return -log_one_minus_thin(rho)
