"""Ashikhmin-Shirley lobe: sampler."""

from shaderlib.direction.mirror import mirror
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import inverse_sqrt, max, normalize, sqrt, vec3
from shaderlib.lobes.domains import UniformPair
from shaderlib.lobes.power_defect import power_defect
from shaderlib.sampling.unit_circle import unit_circle


def ashikhmin_shirley_sample(
    u: UniformPair, v: Direction, exponent_x: Exponent, exponent_y: Exponent
) -> vec3:
    """Direction to the light, drawn with density ashikhmin_shirley_pdf.

    u           pair of uniform numbers in [0, 1); (0, 0) is the mirror direction of v
    v           direction to the viewer, in the local frame
    exponent_x  sharpness across the tangent direction
    exponent_y  sharpness across the bitangent direction
    returns     unit vector, possibly below the horizon. The weight value l.z / pdf is l.z / max(l.z, v.z)
    form        with a = exponent_x + 1, b = exponent_y + 1 and a point (c, s) of the unit circle the azimuth
                of h is (sqrt(b) c, sqrt(a) s) / sqrt(d), d = b c^2 + a s^2, and its exponent a b / d - 1: the
                paper's distribution without its arc tangent and its case for each quadrant
    source      Ashikhmin and Shirley 2000; form derived for this library
    """
    a = exponent_x + 1.0
    b = exponent_y + 1.0
    circle = unit_circle(u.y)
    x = sqrt(b) * circle.x
    y = sqrt(a) * circle.y
    d = x * x + y * y
    q = power_defect(u.x, max(a * (b / d), 1.0))
    k = sqrt(max(q * (2.0 - q), 0.0)) * inverse_sqrt(d)
    return normalize(mirror(v, vec3(k * x, k * y, 1.0 - q)))
