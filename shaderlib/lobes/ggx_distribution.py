"""Density of GGX microfacets."""

from typing import Annotated

from shaderlib.constants import INV_PI, TINY_SQUARE
from shaderlib.lang import Interval, dot, f32, helper, max, min, vec3
from shaderlib.lobes.domains import Roughness


@helper
def ggx_distribution(g: Annotated[vec3, Interval(-2.0, 2.0)], alpha_x: Roughness, alpha_y: Roughness) -> f32:
    """Density D(h) of microfacet normals, area per projected area and steradian.

    g           half_sum of l and v; h = g / |g|
    alpha_x     width along the tangent
    alpha_y     width along the bitangent
    returns     1 / (pi alpha_x alpha_y ((h.x / alpha_x)^2 + (h.y / alpha_y)^2 + h.z^2)^2); at most
                1 / (pi alpha_x alpha_y)
    degenerate  l = -v: 0
    form        a ratio of two sums of squares, at most 1, then its square: no 1 - (n.h)^2, which keeps no
                digit for smooth surfaces
    source      Trowbridge and Reitz 1975; Walter, Marschner, Li and Torrance 2007
    """
    x = g.x / alpha_x
    y = g.y / alpha_y
    ratio = min(dot(g, g) / max(x * x + y * y + g.z * g.z, TINY_SQUARE), 1.0)
    return (INV_PI / (alpha_x * alpha_y)) * (ratio * ratio)
