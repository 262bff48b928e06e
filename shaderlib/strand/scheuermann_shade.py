"""Hair with two shifted highlights."""

from shaderlib.direction.half_vector import half_vector
from shaderlib.domains import (
    Colour,
    Direction,
    Exponent,
    ExponentFrom8,
    ExponentFrom16,
    TangentShift,
    UnitInterval,
)
from shaderlib.lang import clamp, dot, f32, helper, variant, vec3
from shaderlib.strand.strand_specular_half import (
    strand_specular_half,
    strand_specular_half_cubic8,
    strand_specular_half_from4,
    strand_specular_half_from8,
)
from shaderlib.strand.tangent_shift import tangent_shift


@helper
def scheuermann_highlight(
    t: Direction, n: Direction, h: Direction, exponent: Exponent, shift: TangentShift
) -> f32:
    """One highlight of scheuermann_shade.

    t         strand tangent, root to tip
    n         surface normal
    h         half_vector of light and viewer
    exponent  sharpness of the highlight, in [0, 1e5]
    shift     displacement of the tangent along n
    returns   strand_specular_half of the shifted tangent, faded out where h points back along the strand
    form      safe_smoothstep(-1, 0, t.h), written out: its width is 1
    source    Scheuermann 2004, Practical Real-Time Hair Rendering and Shading
    """
    shifted = tangent_shift(t, n, shift)
    s = clamp(1.0 + dot(shifted, h), 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s) * strand_specular_half(shifted, h, exponent)


def scheuermann_shade(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    base: Colour,
    primary: Colour,
    primary_exponent: Exponent,
    primary_shift: TangentShift,
    secondary: Colour,
    secondary_exponent: Exponent,
    secondary_shift: TangentShift,
    mask: UnitInterval,
) -> vec3:
    """Light reflected by hair with a soft diffuse term and two shifted highlights, after Scheuermann.

    t                   strand tangent, root to tip
    n                   surface normal
    l                   direction to the light
    v                   direction to the viewer
    base                hair colour, linear RGB; multiplies everything
    primary             colour of the first highlight, linear RGB
    primary_exponent    its sharpness, in [0, 1e5]
    primary_shift       its displacement; positive moves it toward the tip, as Scheuermann's first highlight
    secondary           colour of the second highlight, linear RGB
    secondary_exponent  its sharpness, in [0, 1e5]
    secondary_shift     its displacement; negative moves it toward the root, as Scheuermann's second one
    mask                noise in [0, 1] that breaks up the second highlight
    returns             base (d + primary s1 + mask secondary s2), d = clamp(0.25 + 0.75 n.l, 0, 1); multiply
                        by the colour of the light
    degenerate          l = -v: half_vector decides; n.l <= 0: the highlights stay, multiply by
                        inherited_shadow where that is not wanted
    form                as the published ports agree, except that shifts follow tangent_shift
    source              Scheuermann 2004, Practical Real-Time Hair Rendering and Shading
    """
    h = half_vector(l, v)
    d = clamp(0.25 + 0.75 * dot(n, l), 0.0, 1.0)
    s1 = scheuermann_highlight(t, n, h, primary_exponent, primary_shift)
    s2 = scheuermann_highlight(t, n, h, secondary_exponent, secondary_shift)
    return base * (vec3(d) + s1 * primary + (mask * s2) * secondary)


@helper
def scheuermann_fade(t: Direction, h: Direction) -> f32:
    """Factor by which scheuermann_shade fades a highlight where h points back along the strand.

    t        strand tangent, shifted
    h        half_vector of light and viewer
    returns  safe_smoothstep(-1, 0, t.h)
    form     written out: its width is 1
    source   Scheuermann 2004, Practical Real-Time Hair Rendering and Shading
    """
    s = clamp(1.0 + dot(t, h), 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


@variant("scheuermann_shade")
def scheuermann_shade_from4(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    base: Colour,
    primary: Colour,
    primary_exponent: ExponentFrom8,
    primary_shift: TangentShift,
    secondary: Colour,
    secondary_exponent: ExponentFrom8,
    secondary_shift: TangentShift,
    mask: UnitInterval,
) -> vec3:
    """Light reflected by hair with two shifted highlights of exponents from 8 on, without logarithms.

    t                   strand tangent, root to tip
    n                   surface normal
    l                   direction to the light
    v                   direction to the viewer
    base                hair colour, linear RGB; multiplies everything
    primary             colour of the first highlight, linear RGB
    primary_exponent    its sharpness, in [8, 1e5]
    primary_shift       its displacement; positive moves it toward the tip
    secondary           colour of the second highlight, linear RGB
    secondary_exponent  its sharpness, in [8, 1e5]
    secondary_shift     its displacement; negative moves it toward the root
    mask                noise in [0, 1] that breaks up the second highlight
    returns             base (d + primary s1 + mask secondary s2), as scheuermann_shade
    degenerate          l = -v: half_vector decides; n.l <= 0: the highlights stay
    form                scheuermann_shade with strand_specular_half_from4
    source              Scheuermann 2004; strand_specular_half_from4
    """
    h = half_vector(l, v)
    d = clamp(0.25 + 0.75 * dot(n, l), 0.0, 1.0)
    t1 = tangent_shift(t, n, primary_shift)
    t2 = tangent_shift(t, n, secondary_shift)
    s1 = scheuermann_fade(t1, h) * strand_specular_half_from4(t1, h, primary_exponent)
    s2 = scheuermann_fade(t2, h) * strand_specular_half_from4(t2, h, secondary_exponent)
    return base * (vec3(d) + s1 * primary + (mask * s2) * secondary)


@variant("scheuermann_shade")
def scheuermann_shade_from8(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    base: Colour,
    primary: Colour,
    primary_exponent: ExponentFrom16,
    primary_shift: TangentShift,
    secondary: Colour,
    secondary_exponent: ExponentFrom16,
    secondary_shift: TangentShift,
    mask: UnitInterval,
) -> vec3:
    """Light reflected by hair with two shifted highlights of exponents from 16 on, by two exponentials.

    t                   strand tangent, root to tip
    n                   surface normal
    l                   direction to the light
    v                   direction to the viewer
    base                hair colour, linear RGB; multiplies everything
    primary             colour of the first highlight, linear RGB
    primary_exponent    its sharpness, in [16, 1e5]
    primary_shift       its displacement; positive moves it toward the tip
    secondary           colour of the second highlight, linear RGB
    secondary_exponent  its sharpness, in [16, 1e5]
    secondary_shift     its displacement; negative moves it toward the root
    mask                noise in [0, 1] that breaks up the second highlight
    returns             base (d + primary s1 + mask secondary s2), as scheuermann_shade
    degenerate          l = -v: half_vector decides; n.l <= 0: the highlights stay
    form                scheuermann_shade with strand_specular_half_from8
    source              Scheuermann 2004; strand_specular_half_from8
    """
    h = half_vector(l, v)
    d = clamp(0.25 + 0.75 * dot(n, l), 0.0, 1.0)
    t1 = tangent_shift(t, n, primary_shift)
    t2 = tangent_shift(t, n, secondary_shift)
    s1 = scheuermann_fade(t1, h) * strand_specular_half_from8(t1, h, primary_exponent)
    s2 = scheuermann_fade(t2, h) * strand_specular_half_from8(t2, h, secondary_exponent)
    return base * (vec3(d) + s1 * primary + (mask * s2) * secondary)


@variant("scheuermann_shade")
def scheuermann_shade_cubic8(
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    base: Colour,
    primary: Colour,
    primary_exponent: ExponentFrom16,
    primary_shift: TangentShift,
    secondary: Colour,
    secondary_exponent: ExponentFrom16,
    secondary_shift: TangentShift,
    mask: UnitInterval,
) -> vec3:
    """Light reflected by hair with two shifted highlights of exponents from 16 on, by polynomials.

    t                   strand tangent, root to tip
    n                   surface normal
    l                   direction to the light
    v                   direction to the viewer
    base                hair colour, linear RGB; multiplies everything
    primary             colour of the first highlight, linear RGB
    primary_exponent    its sharpness, in [16, 1e5]
    primary_shift       its displacement; positive moves it toward the tip
    secondary           colour of the second highlight, linear RGB
    secondary_exponent  its sharpness, in [16, 1e5]
    secondary_shift     its displacement; negative moves it toward the root
    mask                noise in [0, 1] that breaks up the second highlight
    returns             base (d + primary s1 + mask secondary s2), as scheuermann_shade
    degenerate          l = -v: half_vector decides; n.l <= 0: the highlights stay
    form                scheuermann_shade with strand_specular_half_cubic8
    source              Scheuermann 2004; strand_specular_half_cubic8
    """
    h = half_vector(l, v)
    d = clamp(0.25 + 0.75 * dot(n, l), 0.0, 1.0)
    t1 = tangent_shift(t, n, primary_shift)
    t2 = tangent_shift(t, n, secondary_shift)
    s1 = scheuermann_fade(t1, h) * strand_specular_half_cubic8(t1, h, primary_exponent)
    s2 = scheuermann_fade(t2, h) * strand_specular_half_cubic8(t2, h, secondary_exponent)
    return base * (vec3(d) + s1 * primary + (mask * s2) * secondary)
