"""Light that an isotropic lobe gathers from a prefiltered map."""

from shaderlib.domains import Direction
from shaderlib.environment.domains import ParaboloidMap
from shaderlib.environment.env_level import env_level
from shaderlib.lang import vec3


def env_prefiltered(env: ParaboloidMap, w: Direction) -> vec3:
    """Light that a power of the cosine gathers about a direction, from a map convolved with that lobe.

    env         what `vair env --prefilter EXPONENT` writes for one exponent p, in the layout of env_radiance.
                Only its largest level is read; it needs no others
    w           direction that the lobe is about, in the map's axes: the mirror direction of the viewer for a
                Phong lobe, the normal for a Lambert lobe, which is p = 1
    returns     (p + 1) / (2 pi) times the integral of radiance max(0, w.l)^p over the sphere of l, linear
                RGB: a mean of radiance, without a reflectance or a further cosine
    degenerate  a map of one texel: that texel, from everywhere
    form        one lookup, a second one at the rim. It cannot serve lobes that are not round: the cone of a
                strand changes its width with the viewer. 32 texels along a disc for p <= 10, 64 for p <= 100
                err by 1 to 2 percent
    source      Kautz, Vazquez, Heidrich and Seidel 2000, A Unified Approach to Prefiltered Environment Maps
    """
    return env_level(env, w, 0)
