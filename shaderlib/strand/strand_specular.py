"""Specular reflection of a strand."""

from shaderlib.domains import Direction, Exponent, ExponentFrom4, ExponentFrom8
from shaderlib.lang import f32, variant
from shaderlib.numeric.pow_one_minus import (
    pow_one_minus,
    pow_one_minus_cubic8,
    pow_one_minus_from4,
    pow_one_minus_from8,
    pow_one_minus_gauss,
    pow_one_minus_sq16,
)
from shaderlib.numeric.safe_pow import safe_pow_exp2
from shaderlib.strand.strand_cosine import strand_cosine_direct
from shaderlib.strand.strand_defect import strand_defect, strand_defect_half


def strand_specular(t: Direction, l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Specular lobe of a strand: max(0, strand_cosine)^exponent.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    exponent    sharpness of the highlight, in [0, 1e5]
    returns     1 on the cone t.v = -t.l, falling to 0; multiply by the specular colour
    degenerate  exponent 0: 1 everywhere, also on the dark side, where any other exponent gives 0
    form        (1 - q)^exponent with the defect q of strand_angles: the error grows as 1e-7 sqrt(exponent),
                as the rounding of the vectors alone makes it. pow(sin sin - cos cos, exponent) is 9e-2 off
                near the strand's axis at 1e5, and undefined on the dark side
    source      Kajiya and Kay 1989, specular component; Banks 1994; sign as in strand_cosine
    """
    return pow_one_minus(strand_defect(t, l, v), exponent)


@variant("strand_specular")
def strand_specular_from4(t: Direction, l: Direction, v: Direction, exponent: ExponentFrom4) -> f32:
    """Specular lobe of a strand for exponents from 4 on, without a logarithm.

    t         strand tangent, root to tip
    l         direction to the light
    v         direction to the viewer
    exponent  sharpness of the highlight, in [4, 1e5]
    returns   1 on the cone t.v = -t.l, falling to 0; at most 2.5e-6 on the dark side
    form      pow_one_minus_from4 of the defect by half angles
    source    strand_specular; pow_one_minus_from4
    """
    return pow_one_minus_from4(strand_defect_half(t, l, v), exponent)


@variant("strand_specular")
def strand_specular_gauss(t: Direction, l: Direction, v: Direction, exponent: ExponentFrom8) -> f32:
    """Specular lobe of a strand for exponents from 8 on, by one exponential.

    t         strand tangent, root to tip
    l         direction to the light
    v         direction to the viewer
    exponent  sharpness of the highlight, in [8, 1e5]
    returns   1 on the cone t.v = -t.l, falling to 0; at most 2e-7 on the dark side
    form      pow_one_minus_gauss of the defect by half angles: 0.112 / exponent^2
    source    strand_specular; pow_one_minus_gauss
    """
    return pow_one_minus_gauss(strand_defect_half(t, l, v), exponent)


@variant("strand_specular")
def strand_specular_sq16(t: Direction, l: Direction, v: Direction, exponent: ExponentFrom8) -> f32:
    """Specular lobe of a strand for exponents from 8 on, without a transcendental function.

    t         strand tangent, root to tip
    l         direction to the light
    v         direction to the viewer
    exponent  sharpness of the highlight, in [8, 1e5]; best from 16 on
    returns   1 on the cone t.v = -t.l, falling to 0
    form      pow_one_minus_sq16 of the defect by half angles: cheaper than the obvious form, and
              nowhere worse than a quarter of half an 8-bit step from exponent 16 on
    source    strand_specular; pow_one_minus_sq16
    """
    return pow_one_minus_sq16(strand_defect_half(t, l, v), exponent)


@variant("strand_specular")
def strand_specular_from8(t: Direction, l: Direction, v: Direction, exponent: ExponentFrom8) -> f32:
    """Specular lobe of a strand for exponents from 8 on, by one exponential and without a division.

    t         strand tangent, root to tip
    l         direction to the light
    v         direction to the viewer
    exponent  sharpness of the highlight, in [8, 1e5]
    returns   1 on the cone t.v = -t.l, falling to 0; at most 2e-7 on the dark side
    form      pow_one_minus_from8 of the defect by half angles
    source    strand_specular; pow_one_minus_from8
    """
    return pow_one_minus_from8(strand_defect_half(t, l, v), exponent)


@variant("strand_specular")
def strand_specular_cubic8(t: Direction, l: Direction, v: Direction, exponent: ExponentFrom8) -> f32:
    """Specular lobe of a strand for exponents from 8 on, without transcendental function or division.

    t         strand tangent, root to tip
    l         direction to the light
    v         direction to the viewer
    exponent  sharpness of the highlight, in [8, 1e5]
    returns   1 on the cone t.v = -t.l, falling to 0
    form      pow_one_minus_cubic8 of the defect by half angles: an eleventh of half an 8-bit step
    source    strand_specular; pow_one_minus_cubic8
    """
    return pow_one_minus_cubic8(strand_defect_half(t, l, v), exponent)


@variant("strand_specular")
def strand_specular_direct(t: Direction, l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Specular lobe of a strand as usually written: a power of the cosine.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    exponent    sharpness of the highlight, in [0, 1e5]
    returns     1 on the cone t.v = -t.l, falling to 0
    degenerate  exponent 0: 1 everywhere
    form        pow(max(0, sin sin - cos cos), exponent) with sines from cosines; good for low exponents and
                directions away from the strand's axis
    source      Kajiya and Kay 1989, specular component
    """
    return safe_pow_exp2(strand_cosine_direct(t, l, v), exponent)
