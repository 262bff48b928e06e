"""Fake fur without exponential or logarithm, for highlights of exponent 8 and more."""

from shaderlib.domains import Colour, Direction
from shaderlib.fakefur.fakefur_shade import LightColour, fakefur_blend
from shaderlib.fakefur.fur_coat import FurCoat
from shaderlib.fakefur.fur_geometry import fur_geometry
from shaderlib.fakefur.fur_optics import FurOptics
from shaderlib.fakefur.fur_weights_goldman import (
    fur_weights_goldman_doubling_short,
    fur_weights_goldman_rational,
)
from shaderlib.fakefur.fur_weights_slab import fur_weights_slab, fur_weights_slab_rational
from shaderlib.lang import min, variant, vec3
from shaderlib.numeric.pow_one_minus import LARGEST_DEFECT, pow_one_minus_cubic8, pow_one_minus_from4


@variant("fakefur_shade")
def fakefur_shade_rational_cubic8(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Goldman's model for highlights of exponent 8 and more, without exponential or logarithm.

    coat     geometry of the coat
    optics   optical properties of the hairs; exponent >= 8 (finite for all)
    t        hair direction, root to tip
    n        surface normal
    l        direction to the light
    v        direction to the viewer
    light    linear RGB of the light at this point
    skin     reflectance of the skin from l to v, its n.l included
    returns  linear RGB, in the unit of light
    form     fakefur_shade with fur_weights_goldman_rational and pow_one_minus_cubic8
    source   Goldman 1997, Fake Fur Rendering; fits made for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_goldman_rational(geometry.depth_view, geometry.depth_light, optics.overlap)
    highlight = pow_one_minus_cubic8(min(geometry.defect, LARGEST_DEFECT), optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@variant("fakefur_shade")
def fakefur_shade_doubling_cubic8(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Goldman's model for highlights of exponent 8 and more, by polynomials alone.

    coat     geometry of the coat
    optics   optical properties of the hairs; exponent >= 8 (finite for all)
    t        hair direction, root to tip
    n        surface normal
    l        direction to the light
    v        direction to the viewer
    light    linear RGB of the light at this point
    skin     reflectance of the skin from l to v, its n.l included
    returns  linear RGB, in the unit of light
    form     fakefur_shade with fur_weights_goldman_doubling_short and pow_one_minus_cubic8: what divides is
             left in fur_geometry
    source   Goldman 1997, Fake Fur Rendering; fits made for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_goldman_doubling_short(geometry.depth_view, geometry.depth_light, optics.overlap)
    highlight = pow_one_minus_cubic8(min(geometry.defect, LARGEST_DEFECT), optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@variant("fakefur_shade_slab")
def fakefur_shade_slab_from4(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Fake fur of a uniform coat for highlights of exponent 4 and more, without a logarithm.

    coat     geometry of the coat
    optics   optical properties of the hairs; exponent >= 4 (finite for all)
    t        hair direction, root to tip
    n        surface normal
    l        direction to the light
    v        direction to the viewer
    light    linear RGB of the light at this point
    skin     reflectance of the skin from l to v, its n.l included
    returns  linear RGB, in the unit of light
    form     fakefur_shade_slab with pow_one_minus_from4
    source   Goldman 1997, Fake Fur Rendering; fits made for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_slab(geometry.depth_view, geometry.depth_light)
    highlight = pow_one_minus_from4(min(geometry.defect, LARGEST_DEFECT), optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)


@variant("fakefur_shade_slab")
def fakefur_shade_slab_rational_cubic8(
    coat: FurCoat,
    optics: FurOptics,
    t: Direction,
    n: Direction,
    l: Direction,
    v: Direction,
    light: LightColour,
    skin: Colour,
) -> vec3:
    """Fake fur of a uniform coat for highlights of exponent 8 and more, without exponential or logarithm.

    coat     geometry of the coat
    optics   optical properties of the hairs; exponent >= 8 (finite for all)
    t        hair direction, root to tip
    n        surface normal
    l        direction to the light
    v        direction to the viewer
    light    linear RGB of the light at this point
    skin     reflectance of the skin from l to v, its n.l included
    returns  linear RGB, in the unit of light
    form     fakefur_shade_slab with fur_weights_slab_rational and pow_one_minus_cubic8
    source   Goldman 1997, Fake Fur Rendering; fits made for this library
    """
    geometry = fur_geometry(coat, t, n, l, v)
    weights = fur_weights_slab_rational(geometry.depth_view, geometry.depth_light)
    highlight = pow_one_minus_cubic8(min(geometry.defect, LARGEST_DEFECT), optics.exponent)
    return fakefur_blend(optics, geometry, weights, highlight, light, skin)
