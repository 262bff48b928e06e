"""Strands that lie on a surface."""

from shaderlib.domains import Colour, Direction, Exponent, ExponentFrom4, ExponentFrom8
from shaderlib.lang import variant, vec3
from shaderlib.strand.inherited_shadow import inherited_shadow
from shaderlib.strand.kajiya_kay_shade import (
    kajiya_kay_shade,
    kajiya_kay_shade_cubic8,
    kajiya_kay_shade_from4,
    kajiya_kay_shade_from8,
)


def banks_shade(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: Exponent,
) -> vec3:
    """Light reflected by a surface that is made of strands, after Banks.

    t           strand tangent, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [0, 1e5]
    returns     inherited_shadow (k_diffuse strand_diffuse + k_specular strand_specular); multiply by the
                colour of the light
    degenerate  light below the surface (n.l <= 0): 0
    form        kajiya_kay_shade times the cosine of the surface
    source      Banks 1994; lecture VGP352 week 6, inherited self-shadowing
    """
    return inherited_shadow(n, l) * kajiya_kay_shade(t, l, v, k_diffuse, k_specular, exponent)


@variant("banks_shade")
def banks_shade_from4(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom4,
) -> vec3:
    """Light reflected by a surface that is made of strands, for exponents from 4 on, without a logarithm.

    t           strand tangent, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [4, 1e5]
    returns     inherited_shadow (k_diffuse strand_diffuse + k_specular strand_specular); multiply by the
                colour of the light
    degenerate  light below the surface (n.l <= 0): 0
    form        kajiya_kay_shade_from4 times the cosine of the surface
    source      Banks 1994; kajiya_kay_shade_from4
    """
    return inherited_shadow(n, l) * kajiya_kay_shade_from4(t, l, v, k_diffuse, k_specular, exponent)


@variant("banks_shade")
def banks_shade_from8(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom8,
) -> vec3:
    """Light reflected by a surface that is made of strands, for exponents from 8 on, by one exponential.

    t           strand tangent, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [8, 1e5]
    returns     inherited_shadow (k_diffuse strand_diffuse + k_specular strand_specular); multiply by the
                colour of the light
    degenerate  light below the surface (n.l <= 0): 0
    form        kajiya_kay_shade_from8 times the cosine of the surface
    source      Banks 1994; kajiya_kay_shade_from8
    """
    return inherited_shadow(n, l) * kajiya_kay_shade_from8(t, l, v, k_diffuse, k_specular, exponent)


@variant("banks_shade")
def banks_shade_cubic8(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom8,
) -> vec3:
    """Light reflected by a surface that is made of strands, for exponents from 8 on, by polynomials.

    t           strand tangent, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [8, 1e5]
    returns     inherited_shadow (k_diffuse strand_diffuse + k_specular strand_specular); multiply by the
                colour of the light
    degenerate  light below the surface (n.l <= 0): 0
    form        kajiya_kay_shade_cubic8 times the cosine of the surface
    source      Banks 1994; kajiya_kay_shade_cubic8
    """
    return inherited_shadow(n, l) * kajiya_kay_shade_cubic8(t, l, v, k_diffuse, k_specular, exponent)
