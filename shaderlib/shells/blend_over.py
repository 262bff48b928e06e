"""Compositing of one layer over another."""

from typing import Annotated

from shaderlib.domains import UnitInterval
from shaderlib.lang import Interval, vec3

# Linear RGB of a picture, in scene units of radiance.
Radiance = Annotated[vec3, Interval(0.0, 1.0e4)]


def blend_over(under: Radiance, over: Radiance, alpha: UnitInterval) -> vec3:
    """Colour of a layer drawn over another one, with straight alpha.

    under    linear RGB behind the layer
    over     linear RGB of the layer, not multiplied by alpha
    alpha    opacity of the layer
    returns  under (1 - alpha) + over alpha: exactly under for alpha = 0 and exactly over for alpha = 1
    form     both ends are exact under any rounding; under + alpha (over - under) misses over by its
             rounding
    source   Porter and Duff 1984, Compositing Digital Images
    """
    return under * (1.0 - alpha) + over * alpha
