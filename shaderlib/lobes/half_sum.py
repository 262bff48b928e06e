"""Sum of two unit vectors, along their half vector."""

from shaderlib.domains import Direction
from shaderlib.lang import helper, vec3


@helper
def half_sum(l: Direction, v: Direction) -> vec3:
    """The half vector of two directions times |l + v|, accurate even for l close to -v.

    l        direction to the light
    v        direction to the viewer
    returns  l / |l| + v / |v| up to a relative 1e-6 of its length; 0 for l = -v
    form     l + v less its component along l - v. For unit vectors the two are orthogonal; what the rounding
             of the lengths leaves along l - v turns the half vector by 1e-7 / |l + v|, which a narrow lobe
             at grazing multiplies. The inner product is written out: OpenCL promises its built-in to 6e-7 of
             the largest component squared only, which may exceed a small g
    source   derived for this library
    """
    d = l - v
    g = l + v
    return g - (0.25 * (g.x * d.x + g.y * d.y + g.z * d.z)) * d
