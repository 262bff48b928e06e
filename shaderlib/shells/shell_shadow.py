"""Shadow inside a stack of shells."""

from shaderlib.domains import UnitInterval
from shaderlib.lang import f32


def shell_shadow(height: UnitInterval, s_min: UnitInterval) -> f32:
    """Share of the light that reaches a shell through the fur above it.

    height   height of the shell, 0 at the skin and 1 at the top, see shell_height
    s_min    share that reaches the skin
    returns  s_min (1 - height) + height: exactly s_min at the skin and exactly 1 at the top
    form     both ends are exact under any rounding; s_min + height (1 - s_min) may give 0.99999994 at the
             top
    source   Romanick 2010, VGP352 week 6, "Lighting Shells and Fins", with the height of the outermost
             shell for its number of shells
    """
    return s_min * (1.0 - height) + height
