"""Opacity of a fin by the direction it is seen from."""

from shaderlib.domains import Direction
from shaderlib.lang import abs, clamp, dot, f32


def fin_opacity(v: Direction, n_fin: Direction) -> f32:
    """Opacity of a fin: it fades in as it turns its face to the viewer.

    v        direction to the viewer
    n_fin    normal of the fin, see fin_normal; its sign does not matter
    returns  max(0, 2 |v.n_fin| - 1), in [0, 1]: 0 from 60 degrees on
    form     limited to 1, which rounding could exceed
    source   Romanick 2010, VGP352 week 6, "Shells and Fins"; Lengyel et al. 2001
    """
    return clamp(2.0 * abs(dot(v, n_fin)) - 1.0, 0.0, 1.0)
