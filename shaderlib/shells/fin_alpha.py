"""Opacity of a fin texel."""

from shaderlib.domains import UnitInterval
from shaderlib.lang import f32, helper


@helper
def fin_alpha(opacity: UnitInterval, height: UnitInterval, mask: UnitInterval) -> f32:
    """Opacity of a fin texel that is drawn after all shells.

    opacity  of the fin, see fin_opacity_silhouette
    height   of the texel above the skin, 0 to 1
    mask     1 on a hair, 0 beside it
    returns  opacity height^2 mask
    form     shells are closer to the viewer than the root of a fin and farther away than its tip, but all
             of them lie below it in the picture. Fading the root out hides that; a fin that is opaque at
             the root draws a dark contour along the silhouette
    source   found by looking at pictures
    """
    return opacity * height * height * mask
