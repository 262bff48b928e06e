"""Coats that are not everywhere equally dense."""

from shaderlib.domains import UnitInterval
from shaderlib.lang import f32, helper
from shaderlib.numeric.safe_sqrt import safe_sqrt
from shaderlib.shells.shell_shadow import shell_shadow


@helper
def thinned(thickness: UnitInterval, share: UnitInterval) -> f32:
    """Thickness of the hairs of a coat that covers a share of the skin it could cover.

    thickness  of the hairs of the full coat
    share      of the full coat that grows here, in [0, 1]
    returns    thickness sqrt(share): the covered area is proportional to the share
    form       a full coat keeps its thickness to the bit
    source     derived for this library
    """
    return thickness if share >= 1.0 else thickness * safe_sqrt(share)


@helper
def coat_shadow(height: UnitInterval, s_min: UnitInterval, share: UnitInterval) -> f32:
    """Light that is left at a height in a coat that covers a share of the skin.

    height   0 at the skin, 1 at the outermost shell
    s_min    light that reaches the skin below the full coat
    share    of the full coat that grows here, in [0, 1]
    returns  shell_shadow, with s_min moved towards 1 as the coat thins out: bald skin is lit fully
    source   Romanick 2010, VGP352 week 6, "Lighting Shells and Fins"
    """
    return shell_shadow(height, shell_shadow(1.0 - share, s_min))
