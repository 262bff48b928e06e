"""Opacity of a shell seen at a slant."""

from shaderlib.domains import Cosine, UnitInterval
from shaderlib.lang import abs, f32, max
from shaderlib.shells.layered_alpha import layered_alpha

# Longest path that is told apart, in layers; a texel with alpha > 1e-3 is opaque well before.
GRAZING_COSINE = 1.0e-5


def shell_alpha_view(alpha: UnitInterval, n_dot_v: Cosine) -> f32:
    """Opacity of a layer along a slanted line of sight.

    alpha       opacity of the layer seen along the normal
    n_dot_v     cosine between surface normal and viewer; shells are seen from behind too, so its sign is
                ignored
    returns     1 - (1 - alpha)^(1 / |n.v|), in [0, 1]
    degenerate  alpha = 0: 0; alpha = 1: 1; |n.v| below 1e-5 counts as 1e-5
    form        see layered_alpha
    source      Beer-Lambert law
    """
    return layered_alpha(alpha, 1.0 / max(abs(n_dot_v), GRAZING_COSINE))
