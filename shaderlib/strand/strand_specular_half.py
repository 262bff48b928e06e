"""Specular reflection of a strand by the half vector."""

from shaderlib.domains import Direction, Exponent, ExponentFrom8, ExponentFrom16
from shaderlib.lang import dot, f32, variant
from shaderlib.numeric.pow_one_minus import (
    pow_one_minus,
    pow_one_minus_cubic8,
    pow_one_minus_from4,
    pow_one_minus_from8,
    pow_one_minus_gauss,
    pow_one_minus_sq16,
)


def strand_specular_half(t: Direction, h: Direction, exponent: Exponent) -> f32:
    """Specular lobe of a strand after Scheuermann: sin(t, h)^exponent.

    t           strand tangent, root to tip
    h           half_vector of light and viewer
    exponent    sharpness of the highlight, in [0, 1e5]; not that of strand_specular: about a quarter of its
                width around the cone where light and viewer are on one side
    returns     1 where t.h = 0, falling to 0 along the strand
    degenerate  exponent 0: 1 everywhere
    form        (1 - (t.h)^2)^(exponent / 2): no sine at all. A power of any rounded sine is 3e-2 off at 1e5
    source      Scheuermann 2004, Practical Real-Time Hair Rendering and Shading
    """
    c = dot(t, h)
    return pow_one_minus(c * c, 0.5 * exponent)


@variant("strand_specular_half")
def strand_specular_half_from4(t: Direction, h: Direction, exponent: ExponentFrom8) -> f32:
    """Half-vector lobe of a strand for exponents from 8 on, without a logarithm.

    t         strand tangent, root to tip
    h         half_vector of light and viewer
    exponent  sharpness of the highlight, in [8, 1e5]: half of it is the power, from 4 on
    returns   1 where t.h = 0, falling to 0 along the strand
    form      pow_one_minus_from4 of (t.h)^2
    source    strand_specular_half; pow_one_minus_from4
    """
    c = dot(t, h)
    return pow_one_minus_from4(c * c, 0.5 * exponent)


@variant("strand_specular_half")
def strand_specular_half_gauss(t: Direction, h: Direction, exponent: ExponentFrom16) -> f32:
    """Half-vector lobe of a strand for exponents from 16 on, by one exponential.

    t         strand tangent, root to tip
    h         half_vector of light and viewer
    exponent  sharpness of the highlight, in [16, 1e5]: half of it is the power, from 8 on
    returns   1 where t.h = 0, falling to 0 along the strand
    form      pow_one_minus_gauss of (t.h)^2: 0.45 / exponent^2
    source    strand_specular_half; pow_one_minus_gauss
    """
    c = dot(t, h)
    return pow_one_minus_gauss(c * c, 0.5 * exponent)


@variant("strand_specular_half")
def strand_specular_half_sq16(t: Direction, h: Direction, exponent: ExponentFrom16) -> f32:
    """Half-vector lobe of a strand for exponents from 16 on, without a transcendental function.

    t         strand tangent, root to tip
    h         half_vector of light and viewer
    exponent  sharpness of the highlight, in [16, 1e5]: half of it is the power; best from 32 on
    returns   1 where t.h = 0, falling to 0 along the strand
    form      pow_one_minus_sq16 of (t.h)^2
    source    strand_specular_half; pow_one_minus_sq16
    """
    c = dot(t, h)
    return pow_one_minus_sq16(c * c, 0.5 * exponent)


@variant("strand_specular_half")
def strand_specular_half_from8(t: Direction, h: Direction, exponent: ExponentFrom16) -> f32:
    """Half-vector lobe of a strand for exponents from 16 on, by one exponential and without a division.

    t         strand tangent, root to tip
    h         half_vector of light and viewer
    exponent  sharpness of the highlight, in [16, 1e5]: half of it is the power, from 8 on
    returns   1 where t.h = 0, falling to 0 along the strand
    form      pow_one_minus_from8 of (t.h)^2
    source    strand_specular_half; pow_one_minus_from8
    """
    c = dot(t, h)
    return pow_one_minus_from8(c * c, 0.5 * exponent)


@variant("strand_specular_half")
def strand_specular_half_cubic8(t: Direction, h: Direction, exponent: ExponentFrom16) -> f32:
    """Half-vector lobe of a strand for exponents from 16 on, without transcendental function or division.

    t         strand tangent, root to tip
    h         half_vector of light and viewer
    exponent  sharpness of the highlight, in [16, 1e5]: half of it is the power, from 8 on
    returns   1 where t.h = 0, falling to 0 along the strand
    form      pow_one_minus_cubic8 of (t.h)^2
    source    strand_specular_half; pow_one_minus_cubic8
    """
    c = dot(t, h)
    return pow_one_minus_cubic8(c * c, 0.5 * exponent)
