"""Free strands."""

from shaderlib.domains import Colour, Direction, Exponent, ExponentFrom4, ExponentFrom8
from shaderlib.lang import variant, vec3
from shaderlib.numeric.pow_one_minus import (
    pow_one_minus,
    pow_one_minus_cubic8,
    pow_one_minus_from4,
    pow_one_minus_from8,
)
from shaderlib.strand.strand_angles import strand_angles, strand_angles_half


def kajiya_kay_shade(
    t: Direction, l: Direction, v: Direction, k_diffuse: Colour, k_specular: Colour, exponent: Exponent
) -> vec3:
    """Light reflected by a free strand, after Kajiya and Kay.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [0, 1e5]
    returns     k_diffuse strand_diffuse + k_specular strand_specular; multiply by the colour of the light
    form        strand_angles once for both terms; the power through the defect, see strand_specular
    source      Kajiya and Kay 1989, diffuse and specular components
    """
    angles = strand_angles(t, l, v)
    return angles.sin_l * k_diffuse + pow_one_minus(angles.defect, exponent) * k_specular


@variant("kajiya_kay_shade")
def kajiya_kay_shade_from4(
    t: Direction,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom4,
) -> vec3:
    """Light reflected by a free strand, for exponents from 4 on, without a logarithm.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [4, 1e5]
    returns     k_diffuse strand_diffuse + k_specular strand_specular; multiply by the colour of the light
    form        strand_angles_half and pow_one_minus_from4
    source      Kajiya and Kay 1989; pow_one_minus_from4
    """
    angles = strand_angles_half(t, l, v)
    return angles.sin_l * k_diffuse + pow_one_minus_from4(angles.defect, exponent) * k_specular


@variant("kajiya_kay_shade")
def kajiya_kay_shade_from8(
    t: Direction,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom8,
) -> vec3:
    """Light reflected by a free strand, for exponents from 8 on, by one exponential.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [8, 1e5]
    returns     k_diffuse strand_diffuse + k_specular strand_specular; multiply by the colour of the light
    form        strand_angles_half and pow_one_minus_from8
    source      Kajiya and Kay 1989; pow_one_minus_from8
    """
    angles = strand_angles_half(t, l, v)
    return angles.sin_l * k_diffuse + pow_one_minus_from8(angles.defect, exponent) * k_specular


@variant("kajiya_kay_shade")
def kajiya_kay_shade_cubic8(
    t: Direction,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom8,
) -> vec3:
    """Light reflected by a free strand, for exponents from 8 on, by polynomials.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [8, 1e5]
    returns     k_diffuse strand_diffuse + k_specular strand_specular; multiply by the colour of the light
    form        strand_angles_half and pow_one_minus_cubic8
    source      Kajiya and Kay 1989; pow_one_minus_cubic8
    """
    angles = strand_angles_half(t, l, v)
    return angles.sin_l * k_diffuse + pow_one_minus_cubic8(angles.defect, exponent) * k_specular
