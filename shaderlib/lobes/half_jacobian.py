"""Change of density from half vectors to light directions."""

from typing import Annotated

from shaderlib.constants import TINY_SQUARE
from shaderlib.lang import Interval, dot, f32, helper, inverse_sqrt, max, vec3


@helper
def half_jacobian(g: Annotated[vec3, Interval(-2.0, 2.0)]) -> f32:
    """Half vectors per steradian of light directions: 1 / (4 |v.h|) for l mirrored about h.

    g           half_sum of l and v
    returns     1 / (2 |g|)
    degenerate  l = -v: 0. The half vector is undefined there, and a sampler never draws it
    form        v.h = |l + v| / 2 for unit vectors: the sum is exact where it is small, the dot product is not
    source      Walter 2005, Notes on the Ward BRDF; identity derived for this library
    """
    square = dot(g, g)
    return 0.5 * inverse_sqrt(max(square, TINY_SQUARE)) if square > TINY_SQUARE else 0.0
