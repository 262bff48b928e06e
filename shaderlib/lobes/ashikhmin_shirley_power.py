"""The half-vector lobe of Ashikhmin and Shirley."""

from typing import Annotated

from shaderlib.constants import INV_TWO_PI, TINY_SQUARE
from shaderlib.domains import Exponent
from shaderlib.lang import Interval, f32, helper, max, sqrt, vec3
from shaderlib.lobes.half_cosine_power import half_cosine_power


@helper
def ashikhmin_shirley_power(
    g: Annotated[vec3, Interval(-2.0, 2.0)], exponent_x: Exponent, exponent_y: Exponent
) -> f32:
    """Density of half vectors per steradian.

    g           half_sum of l and v
    exponent_x  sharpness across the tangent direction
    exponent_y  sharpness across the bitangent direction
    returns     sqrt((exponent_x + 1) (exponent_y + 1)) / (2 pi) |h.z|^E with E = (exponent_x h.x^2 +
                exponent_y h.y^2) / (h.x^2 + h.y^2), h = g / |g|
    degenerate  h = n: E is of no influence
    form        half_cosine_power; E from the components of g
    source      Ashikhmin and Shirley 2000, An Anisotropic Phong BRDF Model
    """
    xx = g.x * g.x
    yy = g.y * g.y
    exponent = (exponent_x * xx + exponent_y * yy) / max(xx + yy, TINY_SQUARE)
    scale = sqrt((exponent_x + 1.0) * (exponent_y + 1.0)) * INV_TWO_PI
    return scale * half_cosine_power(g, exponent)
