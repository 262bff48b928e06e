"""Opacity of a fin without a normal of its own."""

from shaderlib.direction.sin_angle import sin_angle, sin_angle_cosine
from shaderlib.domains import Direction
from shaderlib.lang import clamp, dot, f32, min, variant

# Minimax in the absolute error of sqrt(1 - x) for x up to 3/4, beyond which the opacity is 0: 7.4e-4.
ROOT_0 = 1.00073493  # 3f801815
ROOT_1 = -0.52582413  # bf069c69
ROOT_2 = 0.0125491992  # 3c4d9b28
ROOT_3 = -0.26711902  # be88c3d3


def fin_opacity_surface(v: Direction, n: Direction) -> f32:
    """Opacity of a fin from the surface normal alone: an upper bound of fin_opacity.

    v        direction to the viewer
    n        surface normal
    returns  max(0, 2 sin(v, n) - 1), in [0, 1]: 0 up to 30 degrees from the normal
    form     |v.n_fin| = sin(v, n) |cos of the azimuth| <= sin(v, n): fins that are seen edge-on are drawn
             too, by up to 1 too opaque (on average 0.44 in place of 0.18 for polar angles uniform in [0,
             90] degrees)
    source   Romanick 2010, VGP352 week 6, "Shells and Fins", second formula
    """
    return clamp(2.0 * sin_angle(v, n) - 1.0, 0.0, 1.0)


@variant("fin_opacity_surface")
def fin_opacity_surface_cosine(v: Direction, n: Direction) -> f32:
    """Opacity of a fin from the surface normal alone, by the cosine.

    v        direction to the viewer
    n        surface normal
    returns  max(0, 2 sin(v, n) - 1), in [0, 1]
    form     sin_angle_cosine: as accurate here, because the sines that it gets wrong are far below 1/2
    source   Romanick 2010, VGP352 week 6, "Shells and Fins", second formula
    """
    return clamp(2.0 * sin_angle_cosine(v, n) - 1.0, 0.0, 1.0)


@variant("fin_opacity_surface")
def fin_opacity_surface_polynomial(v: Direction, n: Direction) -> f32:
    """Opacity of a fin from the surface normal alone, without a root: 1.5e-3.

    v        direction to the viewer
    n        surface normal
    returns  max(0, 2 sin(v, n) - 1) to 1.5e-3, in [0, 1]
    form     the sine as a cubic in the squared cosine, fitted where the opacity is not 0
    source   Romanick 2010, VGP352 week 6, "Shells and Fins", second formula; fitted for this library
    """
    c = dot(v, n)
    x = min(c * c, 1.0)
    return clamp(2.0 * (ROOT_0 + x * (ROOT_1 + x * (ROOT_2 + x * ROOT_3))) - 1.0, 0.0, 1.0)
