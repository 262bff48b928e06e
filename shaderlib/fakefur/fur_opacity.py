"""Opacity of a coat."""

from shaderlib.fakefur.domains import OpticalDepth
from shaderlib.lang import f32, variant
from shaderlib.numeric.one_minus_exp_neg import (
    one_minus_exp_neg,
    one_minus_exp_neg_doubling_short,
    one_minus_exp_neg_rational,
    one_minus_exp_neg_rational_coarse,
)


def fur_opacity(optical_depth: OpticalDepth) -> f32:
    """Share of the skin that is hidden by hairs.

    optical_depth  depth of the coat along the line of sight, see fur_optical_depth
    returns        1 - e^-optical_depth, in [0, 1]; relative error flat down to depths of 1e-30
    form           one_minus_exp_neg: the obvious 1 - exp(-x) is 0 below 6e-8 and 13 percent off at 1e-6
    source         Goldman 1997, Fake Fur Rendering; Romanick 2010, VGP352 week 6, "Fur Opacity"
    """
    return one_minus_exp_neg(optical_depth)


@variant("fur_opacity")
def fur_opacity_rational(optical_depth: OpticalDepth) -> f32:
    """Share of the skin that is hidden by hairs, as a ratio of polynomials.

    optical_depth  depth of the coat along the line of sight, see fur_optical_depth
    returns        1 - e^-optical_depth to 3.9e-4 relative, in [0, 1]
    form           one_minus_exp_neg_rational: no exponential
    source         fitted for this library
    """
    return one_minus_exp_neg_rational(optical_depth)


@variant("fur_opacity")
def fur_opacity_doubling_short(optical_depth: OpticalDepth) -> f32:
    """Share of the skin that is hidden by hairs, by four doublings of a quadratic.

    optical_depth  depth of the coat along the line of sight, see fur_optical_depth
    returns        1 - e^-optical_depth to 4.5e-4 relative, in [0, 1]
    form           one_minus_exp_neg_doubling_short: neither exponential nor division
    source         fitted for this library
    """
    return one_minus_exp_neg_doubling_short(optical_depth)


@variant("fur_opacity")
def fur_opacity_rational_coarse(optical_depth: OpticalDepth) -> f32:
    """Share of the skin that is hidden by hairs, as a ratio of polynomials of low degree.

    optical_depth  depth of the coat along the line of sight, see fur_optical_depth
    returns        1 - e^-optical_depth to 1.1 percent relative, in [0, 1]
    form           one_minus_exp_neg_rational_coarse: no exponential
    source         fitted for this library
    """
    return one_minus_exp_neg_rational_coarse(optical_depth)
