"""Light from an environment map, in one of its levels."""

from shaderlib.domains import Direction
from shaderlib.environment.domains import MAP_BORDER, ParaboloidMap, WholeLevel
from shaderlib.environment.env_disc import env_disc
from shaderlib.lang import abs, f32, helper, min, texture_size, u32, vec3

# Height |w.z| up to which the border of a disc goes on, (1.2^2 - 1) / (1.2^2 + 1), rounded down.
BORDER_HEIGHT = 0.18


@helper
def env_level(env: ParaboloidMap, w: Direction, mip: WholeLevel) -> vec3:
    """Light that comes from a direction, from one level of a dual-paraboloid map.

    env      the map
    w        direction that the light comes from
    mip      the level to look up; the last one stays
    returns  linear RGB, continuous in w
    form     both discs show the directions around the rim, one with its own texels, one in its border. They
             filter what they show differently, so they are blended over the width of one texel, in coarse
             levels over the border: a jump along the rim would be seen in smooth reflections. Elsewhere it is
             one bilinear lookup
    source   dual_paraboloid_uv; the blend: this library
    """
    texel = f32(u32(1) << mip) / texture_size(env).y
    height = abs(w.z)
    back = 1.0 if w.z < 0.0 else 0.0
    own = env_disc(env, w.xy / (1.0 + height), back, mip, texel)
    # Near the rim the radius on a disc changes as fast as w.z, and a texel is 2 MAP_BORDER wide there.
    reach = min(MAP_BORDER * texel, BORDER_HEIGHT)
    if height >= reach:
        return own
    other = env_disc(env, w.xy / (1.0 - height), 1.0 - back, mip, texel)
    share = 0.5 + 0.5 * height / reach
    return share * own + (1.0 - share) * other
