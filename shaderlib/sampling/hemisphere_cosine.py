"""Cosine-distributed directions."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import max, min, sqrt, vec2, vec3
from shaderlib.sampling.disk_concentric import disk_concentric


def hemisphere_cosine(u: UnitSquare) -> vec3:
    """Direction of the upper hemisphere with density cos / pi.

    u        pair of uniform numbers in [0, 1)
    returns  unit vector with z >= 0; the boundary of the square goes to the horizon
    form     a point of the disc lifted to the sphere. Its distance e from the rim is known exactly from u,
             so z = sqrt(e (2 - e)) is accurate down to the horizon; sqrt(1 - x^2 - y^2) has no digit left
             there
    source   Malley's method; Shirley and Chiu 1997, A Low Distortion Map Between Disk and Square
    """
    opposite = vec2(1.0) - u
    rim = 2.0 * max(min(min(u.x, opposite.x), min(u.y, opposite.y)), 0.0)
    return vec3(disk_concentric(u), sqrt(rim * (2.0 - rim)))
