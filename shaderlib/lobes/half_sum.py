"""Sum of two unit vectors, along their half vector."""

from shaderlib.domains import Direction
from shaderlib.lang import dot, helper, vec3


@helper
def half_sum(l: Direction, v: Direction) -> vec3:
    """The half vector of two directions times |l + v|, accurate even for l close to -v.

    l        direction to the light
    v        direction to the viewer
    returns  l / |l| + v / |v| up to a relative 1e-6 of its length; 0 for l = -v
    form     l + v less its component along l - v. For unit vectors the two are orthogonal; what the rounding
             of the lengths leaves along l - v turns the half vector by 1e-7 / |l + v|, which a narrow lobe
             at grazing multiplies
    source   derived for this library
    """
    d = l - v
    g = l + v
    return g - (0.25 * dot(g, d)) * d
