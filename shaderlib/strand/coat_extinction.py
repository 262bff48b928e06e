"""Extinction of a coat from its density."""

from shaderlib.constants import COAT_LIMIT, ONE_BELOW
from shaderlib.domains import UnitInterval
from shaderlib.lang import f32, min
from shaderlib.numeric.log_one_minus import log_one_minus


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
