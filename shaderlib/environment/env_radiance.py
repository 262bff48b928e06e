"""Light from an environment map."""

from shaderlib.domains import Direction
from shaderlib.environment.domains import Level, ParaboloidMap
from shaderlib.environment.env_level import env_level
from shaderlib.lang import clamp, floor, log2, texture_size, u32, vec3


def env_radiance(env: ParaboloidMap, w: Direction, lod: Level) -> vec3:
    """Light that comes from a direction, from a dual-paraboloid map with its levels, as `vair env` writes it.

    env         2 n by n texels, n a power of two: the disc around +z left, the disc around -z right, each in
                a square 1.2 times as wide; levels down to one texel per disc
    w           direction that the light comes from, in the map's axes
    lod         level of the map, 0 for the largest, from lod_from_pdf for instance; the last one stays
    returns     linear RGB, continuous in w and lod
    degenerate  a map of one texel: that texel, from everywhere
    form        two levels are looked up and blended here: each keeps its own distance from the seam between
                the discs, which one trilinear lookup cannot
    source      Heidrich and Seidel 1998, View-independent Environment Maps; Colbert and Krivanek 2007
    """
    held = clamp(lod, 0.0, log2(texture_size(env).y))
    below = floor(held)
    share = held - below
    larger = u32(below)
    return (1.0 - share) * env_level(env, w, larger) + share * env_level(env, w, larger + 1)
