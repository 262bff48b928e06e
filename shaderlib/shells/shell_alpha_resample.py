"""Opacity of a shell when fewer or more shells are drawn than were authored."""

from typing import Annotated

from shaderlib.domains import UnitInterval
from shaderlib.lang import Interval, f32, max, variant
from shaderlib.shells.layered_alpha import layered_alpha, layered_alpha_direct, layered_alpha_thin

# A number of layers; fractions are welcome, for gradual changes of detail.
LayerCount = Annotated[f32, Interval(1.0, 1.0e3, scale="log")]

# Opacity of a layer that is at most half opaque.
HalfInterval = Annotated[f32, Interval(0.0, 0.5)]


def shell_alpha_resample(alpha: UnitInterval, authored: LayerCount, drawn: LayerCount) -> f32:
    """Opacity per layer that keeps the opacity of the whole coat for another number of layers.

    alpha       opacity of a layer as authored
    authored    number of blended layers, the opaque base not counted, that alpha was made for
    drawn       number of blended layers that are drawn; counts as 1 below 1
    returns     1 - (1 - alpha)^(authored / drawn), in [0, 1]
    degenerate  alpha = 0: 0; alpha = 1: 1
    form        see layered_alpha
    source      Beer-Lambert law; exact for a uniform coat
    """
    return layered_alpha(alpha, authored / max(drawn, 1.0))


@variant("shell_alpha_resample")
def shell_alpha_resample_direct(alpha: UnitInterval, authored: LayerCount, drawn: LayerCount) -> f32:
    """Opacity per layer that keeps the opacity of the whole coat for another number of layers.

    alpha     opacity of a layer as authored
    authored  number of blended layers, the opaque base not counted, that alpha was made for
    drawn     number of blended layers that are drawn; counts as 1 below 1
    returns   1 - (1 - alpha)^(authored / drawn), to 1e-5 absolute; alpha = 1: 1
    form      layered_alpha_direct
    source    Beer-Lambert law
    """
    return layered_alpha_direct(alpha, authored / max(drawn, 1.0))


@variant("shell_alpha_resample")
def shell_alpha_resample_thin(alpha: HalfInterval, authored: LayerCount, drawn: LayerCount) -> f32:
    """Opacity per layer that keeps the opacity of the whole coat for another number of layers.

    alpha     opacity of a layer as authored, at most 1/2
    authored  number of blended layers, the opaque base not counted, that alpha was made for
    drawn     number of blended layers that are drawn; counts as 1 below 1
    returns   1 - (1 - alpha)^(authored / drawn), to 0.1 percent
    form      layered_alpha_thin
    source    Beer-Lambert law
    """
    return layered_alpha_thin(alpha, authored / max(drawn, 1.0))
