"""Cosine-distributed directions."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import abs, max, sqrt, vec2, vec3
from shaderlib.sampling.disk_concentric import disk_concentric


def hemisphere_cosine(u: UnitSquare) -> vec3:
    """Direction of the upper hemisphere with density cos / pi.

    u        pair of uniform numbers in [0, 1)
    returns  unit vector with z >= 0; the boundary of the square goes to the horizon
    form     a point of the disc lifted to the sphere. Its distance from the centre is known exactly from u,
             so z = sqrt((1 - r) (1 + r)) is accurate down to the horizon, where sqrt(1 - x^2 - y^2) has no
             digit left
    source   Malley's method; Shirley and Chiu 1997
    """
    d = disk_concentric(u)
    a = 2.0 * u - vec2(1.0)
    r = max(abs(a.x), abs(a.y))
    return vec3(d, sqrt(max((1.0 - r) * (1.0 + r), 0.0)))
