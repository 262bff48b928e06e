"""Blinn-Phong lobe: sampler."""

from shaderlib.direction.mirror import mirror
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import normalize, vec3
from shaderlib.lobes.around_axis import around_axis
from shaderlib.lobes.domains import UniformPair
from shaderlib.lobes.power_defect import power_defect


def blinn_phong_sample(u: UniformPair, v: Direction, exponent: Exponent) -> vec3:
    """Direction to the light, drawn with density blinn_phong_pdf.

    u         pair of uniform numbers in [0, 1); (0, 0) is the mirror direction of v
    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   unit vector, possibly below the horizon
    form      half vector with defect 1 - (1 - u.x)^(1 / (p + 1)) from the normal; v mirrored about it
    source    inversion method
    """
    h = around_axis(power_defect(u.x, exponent + 1.0), u.y)
    return normalize(mirror(v, h))
