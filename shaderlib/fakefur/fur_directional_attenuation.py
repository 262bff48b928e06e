"""Attenuation of a hair by the side it is seen from."""

from shaderlib.domains import Cosine, UnitInterval
from shaderlib.lang import f32, variant


def fur_directional_attenuation(
    azimuth_cosine: Cosine, rho_reflect: UnitInterval, rho_transmit: UnitInterval
) -> f32:
    """Attenuation f_dir of a hair: rho_reflect when front lit, rho_transmit when back lit.

    azimuth_cosine  cosine of the angle between light and viewer around the hair, see strand_azimuth_cosine
    rho_reflect     share of the light that is sent back
    rho_transmit    share of the light that is let through
    returns         (1 + kappa) / 2 rho_reflect + (1 - kappa) / 2 rho_transmit, in [0, 1]
    form            mean plus half the difference times kappa: every step is exact for rho_reflect =
                    rho_transmit, so the result is then that number, bit for bit, on any target
    source          Goldman 1997, Fake Fur Rendering; Romanick 2010, VGP352 week 6, "Directional
                    Attenuation"
    """
    return 0.5 * (rho_reflect + rho_transmit) + 0.5 * azimuth_cosine * (rho_reflect - rho_transmit)


@variant("fur_directional_attenuation")
def fur_directional_attenuation_blend(
    azimuth_cosine: Cosine, rho_reflect: UnitInterval, rho_transmit: UnitInterval
) -> f32:
    """Attenuation f_dir of a hair, as a step from rho_transmit towards rho_reflect.

    azimuth_cosine  cosine of the angle between light and viewer around the hair, see strand_azimuth_cosine
    rho_reflect     share of the light that is sent back
    rho_transmit    share of the light that is let through
    returns         (1 + kappa) / 2 rho_reflect + (1 - kappa) / 2 rho_transmit, in [0, 1] up to rounding
    form            rho_transmit + (1 + kappa) / 2 (rho_reflect - rho_transmit): one operation less, and exact
                    too for rho_reflect = rho_transmit
    source          Goldman 1997, Fake Fur Rendering
    """
    return rho_transmit + (0.5 + 0.5 * azimuth_cosine) * (rho_reflect - rho_transmit)


@variant("fur_directional_attenuation")
def fur_directional_attenuation_mean(
    azimuth_cosine: Cosine, rho_reflect: UnitInterval, rho_transmit: UnitInterval
) -> f32:
    """Attenuation f_dir of a hair whatever side it is seen from.

    azimuth_cosine  not used: what computes it can be left out
    rho_reflect     share of the light that is sent back
    rho_transmit    share of the light that is let through
    returns         (rho_reflect + rho_transmit) / 2, in [0, 1]: off by half their difference at most
    form            the mean over all sides; exact for rho_reflect = rho_transmit
    source          Goldman 1997, Fake Fur Rendering
    """
    return 0.5 * (rho_reflect + rho_transmit)
