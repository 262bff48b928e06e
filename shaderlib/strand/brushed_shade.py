"""Brushed metal, satin and the like: strands from a texture."""

from shaderlib.domains import Colour, Direction, Exponent, ExponentFrom4, ExponentFrom8, MapTangent
from shaderlib.lang import variant, vec3
from shaderlib.strand.banks_shade import banks_shade, banks_shade_cubic8, banks_shade_from4, banks_shade_from8
from shaderlib.strand.tangent_from_map import tangent_from_map


def brushed_shade(
    n: Direction,
    t: Direction,
    map_tangent: MapTangent,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: Exponent,
) -> vec3:
    """Light reflected by a brushed surface: strand lighting with a tangent from a texture, per pixel.

    n            surface normal
    t            tangent of the surface, along the first texture coordinate
    map_tangent  texel of a tangent map, decoded to [-1, 1] per component, in the frame (T, n x T, n) with
                 T = normalize(t - (t.n) n)
    l            direction to the light
    v            direction to the viewer
    k_diffuse    diffuse colour, linear RGB
    k_specular   specular colour, linear RGB
    exponent     sharpness of the highlight, in [0, 1e5]
    returns      banks_shade with the tangent of tangent_from_map; multiply by the colour of the light
    degenerate   light below the surface (n.l <= 0): 0; texel without x and y: brushed along t
    form         tangent_from_map, then banks_shade
    source       Isidoro and Brennan 2002, Per-Pixel Strand Based Anisotropic Lighting
    """
    combed = tangent_from_map(n, t, map_tangent)
    return banks_shade(combed, n, l, v, k_diffuse, k_specular, exponent)


@variant("brushed_shade")
def brushed_shade_from4(
    n: Direction,
    t: Direction,
    map_tangent: MapTangent,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom4,
) -> vec3:
    """Light reflected by a brushed surface, for exponents from 4 on, without a logarithm.

    n            surface normal
    t            tangent of the surface, along the first texture coordinate
    map_tangent  texel of a tangent map, decoded to [-1, 1] per component, as brushed_shade
    l            direction to the light
    v            direction to the viewer
    k_diffuse    diffuse colour, linear RGB
    k_specular   specular colour, linear RGB
    exponent     sharpness of the highlight, in [4, 1e5]
    returns      banks_shade with the tangent of tangent_from_map; multiply by the colour of the light
    degenerate   light below the surface (n.l <= 0): 0; texel without x and y: brushed along t
    form         tangent_from_map, then banks_shade_from4
    source       Isidoro and Brennan 2002; banks_shade_from4
    """
    combed = tangent_from_map(n, t, map_tangent)
    return banks_shade_from4(combed, n, l, v, k_diffuse, k_specular, exponent)


@variant("brushed_shade")
def brushed_shade_from8(
    n: Direction,
    t: Direction,
    map_tangent: MapTangent,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom8,
) -> vec3:
    """Light reflected by a brushed surface, for exponents from 8 on, by one exponential.

    n            surface normal
    t            tangent of the surface, along the first texture coordinate
    map_tangent  texel of a tangent map, decoded to [-1, 1] per component, as brushed_shade
    l            direction to the light
    v            direction to the viewer
    k_diffuse    diffuse colour, linear RGB
    k_specular   specular colour, linear RGB
    exponent     sharpness of the highlight, in [8, 1e5]
    returns      banks_shade with the tangent of tangent_from_map; multiply by the colour of the light
    degenerate   light below the surface (n.l <= 0): 0; texel without x and y: brushed along t
    form         tangent_from_map, then banks_shade_from8
    source       Isidoro and Brennan 2002; banks_shade_from8
    """
    combed = tangent_from_map(n, t, map_tangent)
    return banks_shade_from8(combed, n, l, v, k_diffuse, k_specular, exponent)


@variant("brushed_shade")
def brushed_shade_cubic8(
    n: Direction,
    t: Direction,
    map_tangent: MapTangent,
    l: Direction,
    v: Direction,
    k_diffuse: Colour,
    k_specular: Colour,
    exponent: ExponentFrom8,
) -> vec3:
    """Light reflected by a brushed surface, for exponents from 8 on, by polynomials.

    n            surface normal
    t            tangent of the surface, along the first texture coordinate
    map_tangent  texel of a tangent map, decoded to [-1, 1] per component, as brushed_shade
    l            direction to the light
    v            direction to the viewer
    k_diffuse    diffuse colour, linear RGB
    k_specular   specular colour, linear RGB
    exponent     sharpness of the highlight, in [8, 1e5]
    returns      banks_shade with the tangent of tangent_from_map; multiply by the colour of the light
    degenerate   light below the surface (n.l <= 0): 0; texel without x and y: brushed along t
    form         tangent_from_map, then banks_shade_cubic8
    source       Isidoro and Brennan 2002; banks_shade_cubic8
    """
    combed = tangent_from_map(n, t, map_tangent)
    return banks_shade_cubic8(combed, n, l, v, k_diffuse, k_specular, exponent)
