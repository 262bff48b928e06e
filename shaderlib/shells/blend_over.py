"""Compositing of one layer over another."""

from typing import Annotated

from shaderlib.domains import UnitInterval
from shaderlib.lang import Interval, max, vec3

# Linear RGB of a picture, in scene units of radiance.
Radiance = Annotated[vec3, Interval(0.0, 1.0e4)]


def blend_over(under: Radiance, over: Radiance, alpha: UnitInterval) -> vec3:
    """Colour of a layer drawn over another one, with straight alpha.

    under    linear RGB behind the layer
    over     linear RGB of the layer, not multiplied by alpha
    alpha    opacity of the layer
    returns  under (1 - alpha) + over alpha: exactly under for alpha = 0 and exactly over for alpha = 1
    form     both ends are exact under any rounding; under + alpha (over - under) misses over by its
             rounding, and a dim layer over a bright one by 100 ULP. The max changes no value: it keeps
             compilers that know a (1 - c) + b c as an interpolation from calculating it that way
    source   Porter and Duff 1984, Compositing Digital Images
    """
    return under * max(1.0 - alpha, 0.0) + over * alpha
