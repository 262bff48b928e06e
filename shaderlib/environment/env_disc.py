"""Light that one disc of a dual-paraboloid map shows."""

from typing import Annotated

from shaderlib.environment.domains import MAP_BORDER, ParaboloidMap, TexelShare, WholeLevel
from shaderlib.lang import Interval, clamp, f32, helper, lookup_level, min, vec2, vec3
from shaderlib.maps.domains import MapHalf


@helper
def env_disc(
    env: ParaboloidMap,
    disc: Annotated[vec2, Interval(-1.2, 1.2)],
    back: MapHalf,
    mip: WholeLevel,
    texel: TexelShare,
) -> vec3:
    """Light at a place of one disc of a dual-paraboloid map, in one of its levels.

    env      the map
    disc     place in units of the disc radius; beyond 1 it lies in the border
    back     1 for the disc around -z, 0 for the disc around +z
    mip      the level to look up
    texel    share of the disc's side that a texel of this level takes
    returns  linear RGB
    form     places keep half a texel of the level away from the sides of the disc's square, so that no
             lookup reaches the other disc beside it
    source   Blythe 1999, Advanced Graphics Programming Techniques Using OpenGL; one image for both discs:
             this library
    """
    margin = min(0.5 * texel, 0.5)
    place = clamp((0.5 / MAP_BORDER) * disc + vec2(0.5), vec2(margin), vec2(1.0 - margin))
    return lookup_level(env, vec2(0.5 * (place.x + back), place.y), f32(mip)).xyz
