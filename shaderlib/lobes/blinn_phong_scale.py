"""Normalisation of the Blinn-Phong lobe."""

from shaderlib.constants import EXP_LIMIT, INV_PI
from shaderlib.domains import Exponent
from shaderlib.lang import exp, f32, helper, max

# log(2) / 2
HALF_LOG_TWO = 0.346573590279972655


@helper
def blinn_phong_scale(exponent: Exponent) -> f32:
    """Height of the Blinn-Phong lobe that gives it albedo 1 at normal incidence.

    exponent  p, sharpness of the lobe
    returns   (p + 2) (p + 4) / (8 pi (2^(-p/2) + p)); 1 / pi at p = 0
    form      exact; the popular (p + 8) / (8 pi) approximates it
    source    Giesen 2009, Phong Normalization Factor Derivation
    """
    falloff = exp(max(-HALF_LOG_TWO * exponent, -EXP_LIMIT))
    return (0.125 * INV_PI) * (exponent + 2.0) * ((exponent + 4.0) / (falloff + exponent))
