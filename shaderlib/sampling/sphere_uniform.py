"""Uniform directions."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import max, sqrt, vec3
from shaderlib.sampling.unit_circle import unit_circle


def sphere_uniform(u: UnitSquare) -> vec3:
    """Uniform direction on the unit sphere.

    u        pair of uniform numbers in [0, 1)
    returns  unit vector with z = 1 - 2 u.x and azimuth 2 pi u.y; u.x = 0 is the pole z = 1
    form     the distance from the axis is 2 sqrt(u.x (1 - u.x)), accurate at both poles
    source   Archimedes' hat-box theorem
    """
    radius = 2.0 * sqrt(max(u.x * (1.0 - u.x), 0.0))
    return vec3(radius * unit_circle(u.y), 1.0 - 2.0 * u.x)
