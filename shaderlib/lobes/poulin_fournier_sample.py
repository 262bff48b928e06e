"""Poulin-Fournier lobe: sampler."""

from shaderlib.constants import ONE_BELOW
from shaderlib.direction.mirror import mirror
from shaderlib.domains import Direction, Exponent, UnitInterval
from shaderlib.lang import clamp, max, min, normalize, sqrt, vec2, vec3
from shaderlib.lobes.arc_normal import arc_normal
from shaderlib.lobes.domains import Spread, UniformPair
from shaderlib.lobes.lambert_sample import lambert_sample
from shaderlib.lobes.power_defect import power_defect

# Smallest divisor; below it a branch is never taken.
SMALLEST_SHARE = 1.0e-20


def poulin_fournier_sample(
    u: UniformPair, v: Direction, spread: Spread, specular: UnitInterval, exponent: Exponent
) -> vec3:
    """Direction to the light, drawn with density poulin_fournier_pdf.

    u           pair of uniform numbers in [0, 1); u.x < 1 - specular is the diffuse part
    v           direction to the viewer, in the local frame
    spread      half angle of each cylinder's arc, in radians
    specular    share of the samples that mirror v about a facet; the rest is cosine-distributed
    exponent    p, sharpness of the facets
    returns     unit vector, possibly below the horizon
    degenerate  first number of the highlight part 0: h.x = 0; second number 0: the middle of the arc. Both
                would otherwise fall on the edge of the density; a Hammersley sequence starts there
    form        u.x is stretched over the part it selects. Facets: h.x = sin(eta) with
                1 - cos(eta)^(p + 1) = (2 u - 1)^2, and a uniform angle across the arc
    source      derived for this library
    """
    diffuse_share = 1.0 - specular
    first = clamp(u.x / max(diffuse_share, SMALLEST_SHARE), 0.0, ONE_BELOW)
    diffuse = lambert_sample(vec2(first, u.y), v)
    second = clamp((u.x - diffuse_share) / max(specular, SMALLEST_SHARE), 0.0, ONE_BELOW)
    y = 2.0 * second - 1.0 if second > 0.0 else 0.0
    q = power_defect(min(y * y, ONE_BELOW), exponent + 1.0)
    s = sqrt(max(q * (2.0 - q), 0.0))
    n = arc_normal(spread * (2.0 * u.y - 1.0) if u.y > 0.0 else 0.0)
    h = vec3(s if y >= 0.0 else -s, (1.0 - q) * n.y, (1.0 - q) * n.x)
    return diffuse if u.x < diffuse_share else normalize(mirror(v, h))
