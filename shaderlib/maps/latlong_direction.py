"""Latitude-longitude map coordinates to direction."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import vec3
from shaderlib.sampling.unit_circle import unit_circle


def latlong_direction(uv: UnitSquare) -> vec3:
    """Direction of a point of a latitude-longitude map with y up; undoes latlong_uv.

    uv       texture coordinates: v from the top, u = 1/2 toward -z and growing toward +x
    returns  unit vector (-sin(pi v) sin(2 pi u), cos(pi v), sin(pi v) cos(2 pi u))
    form     unit_circle takes shares of a turn, so no angle in radians is rounded; the built-ins are promised
             to 2^-11 only
    source   usual equirectangular map
    """
    polar = unit_circle(0.5 * uv.y)
    azimuth = unit_circle(uv.x)
    return vec3(-polar.y * azimuth.y, polar.x, polar.y * azimuth.x)
