"""Light that is left after a way through a coat."""

from shaderlib.constants import EXP_LIMIT
from shaderlib.domains import Extinction, PathLength
from shaderlib.lang import exp, f32, min, variant
from shaderlib.numeric.exp_neg_powers import exp_neg_quadratic16

# Minimax in the absolute error against e^-x; x is held at the limit, where both are below the error.
# (1 + x (c1 + x (c2 + x c3)))^16: 6e-6
CUBIC16_1 = -0.0624962859  # bd7ffc1b
CUBIC16_2 = 0.00194483367  # 3afee9ca
CUBIC16_3 = -3.62746578e-05  # b818259e
CUBIC16_LIMIT = 24.0


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
def coat_transmittance_cubic16(extinction: Extinction, path: PathLength) -> f32:
    """Fraction of light that passes a coat, as the sixteenth power of a cubic: 7e-6, without exponential.

    extinction  extinction coefficient, per scene unit, in [0, 1e18]
    path        length of the way, in scene units, in [0, 1e18]
    returns     e^-(extinction path) to 7e-6 absolute, in (0, 1]
    degenerate  extinction 0 or path 0: 1
    form        four squarings; no division either. Opaque coats keep up to 1e-5 of the light
    source      fitted for this library
    """
    x = min(extinction * path, CUBIC16_LIMIT)
    r = 1.0 + x * (CUBIC16_1 + x * (CUBIC16_2 + x * CUBIC16_3))
    r2 = r * r
    r4 = r2 * r2
    r8 = r4 * r4
    return r8 * r8


@variant("coat_transmittance")
def coat_transmittance_quadratic16(extinction: Extinction, path: PathLength) -> f32:
    """Fraction of light that passes a coat, as the sixteenth power of a quadratic: 2.3e-4.

    extinction  extinction coefficient, per scene unit, in [0, 1e18]
    path        length of the way, in scene units, in [0, 1e18]
    returns     e^-(extinction path) to 2.3e-4 absolute, in (0, 1]
    degenerate  extinction 0 or path 0: 1
    form        four squarings; neither exponential nor division. Opaque coats keep up to 2.3e-4 of the light
    source      fitted for this library
    """
    return exp_neg_quadratic16(extinction * path)
