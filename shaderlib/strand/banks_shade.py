"""Strands that lie on a surface."""

from shaderlib.domains import Colour, Direction, Exponent
from shaderlib.lang import vec3
from shaderlib.strand.inherited_shadow import inherited_shadow
from shaderlib.strand.kajiya_kay_shade import kajiya_kay_shade


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
