"""Opacity of a shell seen at a slant."""

from shaderlib.domains import Cosine, UnitInterval
from shaderlib.lang import abs, f32, max, variant
from shaderlib.shells.layered_alpha import layered_alpha, layered_alpha_direct, layered_alpha_thin
from shaderlib.shells.shell_alpha_resample import HalfInterval

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


@variant("shell_alpha_view")
def shell_alpha_view_direct(alpha: UnitInterval, n_dot_v: Cosine) -> f32:
    """Opacity of a layer along a slanted line of sight.

    alpha       opacity of the layer seen along the normal
    n_dot_v     cosine between surface normal and viewer; its sign is ignored
    returns     1 - (1 - alpha)^(1 / |n.v|), to 1e-5 absolute for |n.v| from 0.01 on
    degenerate  |n.v| below 1e-5 counts as 1e-5
    form        layered_alpha_direct
    source      Beer-Lambert law
    """
    return layered_alpha_direct(alpha, 1.0 / max(abs(n_dot_v), GRAZING_COSINE))


@variant("shell_alpha_view")
def shell_alpha_view_thin(alpha: HalfInterval, n_dot_v: Cosine) -> f32:
    """Opacity of a layer along a slanted line of sight.

    alpha       opacity of the layer seen along the normal, at most 1/2
    n_dot_v     cosine between surface normal and viewer; its sign is ignored
    returns     1 - (1 - alpha)^(1 / |n.v|), to 0.1 percent
    degenerate  |n.v| below 1e-5 counts as 1e-5
    form        layered_alpha_thin
    source      Beer-Lambert law
    """
    return layered_alpha_thin(alpha, 1.0 / max(abs(n_dot_v), GRAZING_COSINE))
