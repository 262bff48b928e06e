"""Light that is left after a way through a coat."""

from shaderlib.constants import EXP_LIMIT
from shaderlib.domains import Extinction, PathLength
from shaderlib.lang import exp, f32, min, variant
from shaderlib.numeric.growth_rational import growth_rational


def coat_transmittance(extinction: Extinction, path: PathLength) -> f32:
    """Fraction of light that passes a coat: e^-(extinction path).

    extinction  extinction coefficient, per scene unit, in [0, 1e18]; see coat_extinction
    path        length of the way, in scene units, in [0, 1e18]; see coat_path_slab
    returns     in (0, 1]; not below e^-80 = 1.8e-35
    degenerate  extinction 0 or path 0: 1 up to rounding, also where the other one is 1e18
    form        the argument stops at 80: e^-88 is a denormal number, slow on some drivers, flushed on others
    source      Banks 1994, vector field shadowing, with (1 - rho)^path = e^-(extinction path)
    """
    return exp(-min(extinction * path, EXP_LIMIT))


@variant("coat_transmittance")
def coat_transmittance_rational(extinction: Extinction, path: PathLength) -> f32:
    """Fraction of light that passes a coat, as a rational function: a third of half an 8-bit step.

    extinction  extinction coefficient, per scene unit, in [0, 1e18]
    path        length of the way, in scene units, in [0, 1e18]
    returns     e^-(extinction path) to 6.5e-4 absolute, in (0, 1]
    degenerate  extinction 0 or path 0: 1
    form        1 / (1 + x growth_rational(x)), x = extinction path held at 88; no relative
                accuracy above x = 7
    source      fitted for this library
    """
    x = min(extinction * path, 88.0)
    return 1.0 / (1.0 + x * growth_rational(x))
