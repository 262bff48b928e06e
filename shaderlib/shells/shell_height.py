"""Height of a shell."""

from typing import Annotated

from shaderlib.lang import Interval, f32, max, min, u32


def shell_height(layer: Annotated[u32, Interval(0, 256)], layers: Annotated[u32, Interval(0, 256)]) -> f32:
    """Height of a layer above the skin as a share of the coat's length.

    layer       index of the layer; 0 is the opaque base at the skin
    layers      number of layers, the base included
    returns     layer / (layers - 1), in [0, 1]; exactly 1 at the top layer and above it
    degenerate  layers = 0 or 1: 0
    form        the top is decided on integers: a quotient x / x may miss 1 by 2.5 ulp, and the outermost
                shell would be neither at full height nor fully lit
    source      Lengyel et al. 2001, Real-Time Fur over Arbitrary Surfaces; the lecture divides by the
                number of layers, which darkens the outermost one
    """
    top = max(layers, 2) - 1
    inner = min(f32(layer) / f32(top), 1.0)
    outer = 1.0 if layers > 1 else 0.0
    return outer if layer >= top or layers <= 1 else inner
