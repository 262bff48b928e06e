"""Phong lobe: sampler."""

from shaderlib.direction.frame_from_normal import frame_from_normal
from shaderlib.direction.to_world import to_world
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import normalize, vec3
from shaderlib.lobes.around_axis import around_axis
from shaderlib.lobes.domains import UniformPair
from shaderlib.lobes.power_defect import power_defect


def phong_sample(u: UniformPair, v: Direction, exponent: Exponent) -> vec3:
    """Direction to the light, drawn with density phong_pdf.

    u         pair of uniform numbers in [0, 1); (0, 0) is the mirror direction of v
    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   unit vector, possibly below the horizon. The weight value l.z / pdf is (p + 2) / (p + 1) l.z
    form      defect 1 - (1 - u.x)^(1 / (p + 1)) around the mirror direction, in the frame of
              frame_from_normal. The usual u.x^(1 / (p + 1)) would put the first point of a sequence where the
              density is 0
    source    Lafortune and Willems 1994
    """
    q = power_defect(u.x, exponent + 1.0)
    frame = frame_from_normal(vec3(-v.x, -v.y, v.z))
    return normalize(to_world(frame, around_axis(q, u.y)))
