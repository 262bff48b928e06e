"""Opacity of a fin without a normal of its own."""

from shaderlib.direction.sin_angle import sin_angle, sin_angle_cosine
from shaderlib.domains import Direction
from shaderlib.lang import clamp, f32, variant


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
