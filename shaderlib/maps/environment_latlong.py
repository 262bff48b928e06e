"""Light from a latitude-longitude map."""

from typing import Annotated

from shaderlib.domains import Direction
from shaderlib.lang import Edges, Interval, Texture, f32, lookup_level, vec3
from shaderlib.maps.latlong_uv import latlong_uv

LatLongMap = Annotated[Texture, Edges("repeat", "clamp")]
Level = Annotated[f32, Interval(0.0, 16.0)]


def environment_latlong(environment: LatLongMap, w: Direction, lod: Level) -> vec3:
    """Light that comes from a direction, from a latitude-longitude map with its levels.

    environment  the map, linear RGB, in the layout of latlong_uv
    w            direction that the light comes from
    lod          level of the map, 0 for the largest, from lod_from_pdf for instance; the last one stays
    returns      linear RGB
    degenerate   straight up and down, where every longitude is the same direction: one of the longitudes
    form         one trilinear lookup. The map repeats in u and its first and last rows go on in v, so the
                 seam and the poles need no texels of their own
    source       latlong_uv; the lookup: this library
    """
    return lookup_level(environment, latlong_uv(w), lod).xyz
