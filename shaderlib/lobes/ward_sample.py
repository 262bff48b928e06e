"""Ward lobe: sampler."""

from shaderlib.direction.mirror import mirror
from shaderlib.domains import Direction
from shaderlib.lang import max, normalize, sqrt, vec3
from shaderlib.lobes.domains import Roughness, UniformPair
from shaderlib.numeric.log_one_minus import log_one_minus
from shaderlib.sampling.unit_circle import unit_circle


def ward_sample(u: UniformPair, v: Direction, alpha_x: Roughness, alpha_y: Roughness) -> vec3:
    """Direction to the light, drawn with density ward_pdf.

    u        pair of uniform numbers in [0, 1); (0, 0) is the mirror direction of v
    v        direction to the viewer, in the local frame
    alpha_x  root mean square slope along the tangent
    alpha_y  root mean square slope along the bitangent
    returns  unit vector, possibly below the horizon. The weight value l.z / pdf is 2 l.z / (l.z + v.z), below
             2
    form     the slope of the half vector is a Gaussian: radius sqrt(-log(1 - u.x)), stretched by the two
             widths. The same distribution as with arc tangents and a case for each quadrant
    source   Walter 2005, Notes on the Ward BRDF; slope form derived for this library
    """
    radius = sqrt(max(-log_one_minus(u.x), 0.0))
    circle = unit_circle(u.y)
    h = normalize(vec3(alpha_x * radius * circle.x, alpha_y * radius * circle.y, 1.0))
    return normalize(mirror(v, h))
