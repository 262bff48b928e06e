"""Strand lobe: sampler."""

from shaderlib.constants import ONE_BELOW
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import clamp, length, max, min, normalize, sqrt, vec2, vec3
from shaderlib.lobes.domains import UniformPair
from shaderlib.lobes.power_defect import power_defect
from shaderlib.lobes.strand_mixture import strand_mixture
from shaderlib.sampling.unit_circle import unit_circle

# Smallest divisor of the quotients below; their numerators are 0 wherever it decides.
SMALLEST_DIVISOR = 1.0e-20


def strand_sample(u: UniformPair, v: Direction, exponent: Exponent) -> vec3:
    """Direction to the light, drawn with density strand_pdf: near the cone of mirror directions around x.

    u         pair of uniform numbers in [0, 1); u.x = 0 is on the cone
    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   unit vector anywhere on the sphere; on a surface half of the samples are below the horizon. The
              weight value / pdf is at most 1.64 of its mean, 1.4 from p = 10 on
    form      with c = cos(delta), m = p + 1 and b of strand_mixture, y = sqrt(1 - c^m) has the distribution b
              y^2 + (1 - b) y, inverted by the root that does not cancel. The sign of delta is drawn in
              proportion to the cosine of the elevation it leads to, and u.y is stretched and used again for
              the azimuth
    source    derived for this library
    """
    share = strand_mixture(v, exponent)
    root = sqrt(share.y * share.y + 4.0 * share.x * u.x)
    y = 2.0 * u.x / max(share.y + root, SMALLEST_DIVISOR)
    q = power_defect(min(y * y, ONE_BELOW), exponent + 1.0)
    c = 1.0 - q
    s = sqrt(max(q * (2.0 - q), 0.0))
    from_axis = length(vec2(v.y, v.z))
    raised = max(c * from_axis + s * v.x, 0.0)
    lowered = max(c * from_axis - s * v.x, 0.0)
    both = raised + lowered
    chance = raised / max(both, SMALLEST_DIVISOR) if both > 0.0 else 1.0
    take_raised = u.y < chance
    inside = u.y / max(chance, SMALLEST_DIVISOR)
    outside = (u.y - chance) / max(1.0 - chance, SMALLEST_DIVISOR)
    turns = clamp(inside if take_raised else outside, 0.0, 1.0)
    elevation = (s if take_raised else -s) * from_axis - c * v.x
    return normalize(vec3(elevation, (raised if take_raised else lowered) * unit_circle(turns)))
