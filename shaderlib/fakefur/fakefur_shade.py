"""Goldman's fake fur: the light that a coat of hairs and the skin below it send to the viewer."""

from typing import Annotated

from shaderlib.constants import EXP_LIMIT, TWO_PI
from shaderlib.direction.sin_angle import sin_angle
from shaderlib.domains import Colour, Cosine, Direction, UnitInterval
from shaderlib.fakefur.fur_coat import FurCoat
from shaderlib.fakefur.fur_directional_attenuation import fur_directional_attenuation
from shaderlib.fakefur.fur_geometry import FurGeometry, fur_geometry
from shaderlib.fakefur.fur_hair_area import fur_hair_area_printed
from shaderlib.fakefur.fur_obliquity import fur_obliquity
from shaderlib.fakefur.fur_optics import FurOptics
from shaderlib.fakefur.fur_surface_attenuation import fur_surface_attenuation
from shaderlib.fakefur.fur_weights import FurWeights
from shaderlib.fakefur.fur_weights_goldman import fur_weights_goldman, fur_weights_goldman_rational
from shaderlib.fakefur.fur_weights_slab import fur_weights_slab, fur_weights_slab_rational
from shaderlib.lang import Interval, dot, exp, f32, helper, min, printed, variant, vec3
from shaderlib.numeric.pow_one_minus import (
    LARGEST_DEFECT,
    pow_one_minus,
    pow_one_minus_from4,
    pow_one_minus_sq16,
)
from shaderlib.numeric.safe_pow import safe_pow
from shaderlib.numeric.safe_smoothstep import safe_smoothstep
from shaderlib.numeric.safe_sqrt import safe_sqrt
from shaderlib.numeric.turn_of import turn_of
from shaderlib.strand.strand_azimuth_cosine import strand_azimuth_cosine

# Linear RGB of a light, in the unit in which the result is wanted.
LightColour = Annotated[vec3, Interval(0.0, 1.0e4)]


@helper
def fakefur_blend(
    optics: FurOptics,
    geometry: FurGeometry,
    weights: FurWeights,
    highlight: UnitInterval,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Hair and skin, each attenuated and weighted, under one light.

    optics     optical properties of the hairs
    geometry   directions and depths, see fur_geometry
    weights    weights of hair and skin
    highlight  strand highlight, in [0, 1]
    light      colour of the light
    skin       reflectance of the skin towards the viewer, n.l included
    returns    light (hair weight f_dir f_surface (k_d sin(t, l) + k_s highlight) + skin weight skin)
    form       the scalar factors are joined before they meet a colour
    source     Goldman 1997, Fake Fur Rendering; Romanick 2010, VGP352 week 6
    """
    directional = fur_directional_attenuation(
        geometry.azimuth_cosine, optics.rho_reflect, optics.rho_transmit
    )
    surface = fur_surface_attenuation(geometry.n_dot_l, optics.rho_surface, optics.cos_dark, optics.cos_lit)
    hair = optics.k_diffuse * geometry.sin_l + optics.k_specular * highlight
    return light * (hair * (weights.hair * directional * surface) + skin * weights.skin)


def fakefur_shade(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Light that a fur coat sends to the viewer under one light, by Goldman's model.

    coat        geometry of the coat
    optics      optical properties of the hairs
    t           hair direction, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    light       linear RGB of the light at this point
    skin        reflectance of the skin from l to v, its n.l included
    returns     linear RGB, in the unit of light; add up over the lights
    degenerate  n.v <= 0 or n.l <= 0: that path through the coat is opaque; t = +-l or t = +-v: that sine,
                its depth and the azimuth cosine are 0; exponent 0: the highlight is 1 everywhere; cos_dark
                = cos_lit: a hard step
    form        both cross products once, for sines, azimuth and highlight: faster than the obvious form and
                accurate at every angle. Shadow takes the opacity along the light, visibility along the view
    source      Goldman 1997, Fake Fur Rendering; Romanick 2010, VGP352 week 6, with its misprints put right
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_goldman(geometry.depth_view, geometry.depth_light, optics.overlap)
    highlight = pow_one_minus(geometry.defect, optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@variant("fakefur_shade")
def fakefur_shade_from4(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Goldman's model for highlights of exponent 4 and more, without a logarithm.

    coat     geometry of the coat
    optics   optical properties of the hairs; exponent >= 4 (finite for all)
    t        hair direction, root to tip
    n        surface normal
    l        direction to the light
    v        direction to the viewer
    light    linear RGB of the light at this point
    skin     reflectance of the skin from l to v, its n.l included
    returns  linear RGB, in the unit of light
    form     fakefur_shade with pow_one_minus_from4
    source   Goldman 1997, Fake Fur Rendering; fit made for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_goldman(geometry.depth_view, geometry.depth_light, optics.overlap)
    highlight = pow_one_minus_from4(geometry.defect, optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@variant("fakefur_shade")
def fakefur_shade_rational_sq16(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Goldman's model for highlights of exponent 16 and more, without exponential or logarithm.

    coat     geometry of the coat
    optics   optical properties of the hairs; exponent >= 16 (finite for all, 1.3e-3 off at 8)
    t        hair direction, root to tip
    n        surface normal
    l        direction to the light
    v        direction to the viewer
    light    linear RGB of the light at this point
    skin     reflectance of the skin from l to v, its n.l included
    returns  linear RGB, in the unit of light
    form     fakefur_shade with rational weights and a highlight by four squarings: cheaper than the obvious
             text, with the accurate angles kept
    source   Goldman 1997, Fake Fur Rendering; fits made for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_goldman_rational(geometry.depth_view, geometry.depth_light, optics.overlap)
    highlight = pow_one_minus_sq16(min(geometry.defect, LARGEST_DEFECT), optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@variant("fakefur_shade")
def fakefur_shade_slab(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Fake fur with the exact weights of a uniform coat instead of Goldman's rule: another model.

    coat        geometry of the coat
    optics      optical properties of the hairs; overlap is not used
    t           hair direction, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    light       linear RGB of the light at this point
    skin        reflectance of the skin from l to v, its n.l included
    returns     linear RGB, in the unit of light; add up over the lights
    degenerate  as fakefur_shade
    form        fakefur_shade with fur_weights_slab: one exponential less; brighter rims, darker at grazing
                light, up to 0.48 of the hair's reflectance
    source      Goldman 1997, Fake Fur Rendering; weights derived for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_slab(geometry.depth_view, geometry.depth_light)
    highlight = pow_one_minus(geometry.defect, optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@variant("fakefur_shade_slab")
def fakefur_shade_slab_rational_sq16(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Fake fur of a uniform coat for highlights of exponent 16 and more, without exponential or logarithm.

    coat     geometry of the coat
    optics   optical properties of the hairs; exponent >= 16 (finite for all, 1.3e-3 off at 8)
    t        hair direction, root to tip
    n        surface normal
    l        direction to the light
    v        direction to the viewer
    light    linear RGB of the light at this point
    skin     reflectance of the skin from l to v, its n.l included
    returns  linear RGB, in the unit of light
    form     fakefur_shade_slab with rational weights and a highlight by four squarings
    source   Goldman 1997, Fake Fur Rendering; fits made for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_slab_rational(geometry.depth_view, geometry.depth_light)
    highlight = pow_one_minus_sq16(min(geometry.defect, LARGEST_DEFECT), optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@helper
def angle_of_cosine(x: Cosine) -> f32:
    """Angle whose cosine is x.

    x        cosine, in [-1, 1]
    returns  acos(x), in [0, pi]
    form     turn_of sine and cosine; the built-in acos may err by 6.8e-5 and is undefined above 1, and atan2
             is promised to nothing where either is 0
    source   elementary
    """
    return TWO_PI * turn_of(safe_sqrt((1.0 - x) * (1.0 + x)), x)


@printed("fakefur_shade")
def fakefur_shade_printed(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Goldman's model as the lecture prints it, misprints included.

    coat        geometry of the coat
    optics      optical properties of the hairs; overlap is not used (the slide has 1/2)
    t           hair direction, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    light       linear RGB of the light at this point
    skin        reflectance of the skin from l to v, its n.l included
    returns     linear RGB, in the unit of light
    degenerate  n.v <= 0 counts as 1e-12 and negative bases of the power as 0, as in fakefur_shade
    form        to the letter: half the hair area, the opacity along the view where the light's belongs, a
                highlight that peaks at the mirrored direction (cos cos + sin sin), and a cosine compared
                with angles
    source      Romanick 2010, VGP352 week 6, "Putting it all together"
    """
    hair_cover = coat.density * fur_hair_area_printed(coat.hair_length, coat.radius_base, coat.radius_tip)
    opacity = 1.0 - 1.0 / exp(min(hair_cover * fur_obliquity(t, n, v), EXP_LIMIT))
    sin_l = sin_angle(t, l)
    highlight = safe_pow(dot(t, l) * dot(t, v) + sin_l * sin_angle(t, v), optics.exponent)
    bare = optics.k_diffuse * sin_l + optics.k_specular * highlight
    directional = fur_directional_attenuation(
        strand_azimuth_cosine(t, l, v), optics.rho_reflect, optics.rho_transmit
    )
    lighting = safe_smoothstep(angle_of_cosine(optics.cos_lit), angle_of_cosine(optics.cos_dark), dot(n, l))
    surface = 1.0 + optics.rho_surface * (lighting - 1.0)
    hair = bare * ((1.0 - 0.5 * opacity) * directional * surface)
    return light * (hair * opacity + skin * ((1.0 - opacity) * (1.0 - opacity)))
