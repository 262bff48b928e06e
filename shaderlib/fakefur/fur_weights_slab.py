"""Exact weights of hair and skin for a uniform coat."""

from shaderlib.constants import EXP_LIMIT
from shaderlib.fakefur.domains import OpticalDepth
from shaderlib.fakefur.fur_weights import FurWeights
from shaderlib.lang import exp, max, min, variant
from shaderlib.numeric.exprel_series import exprel_series
from shaderlib.numeric.growth_rational import growth_coarse, growth_rational


def fur_weights_slab(depth_view: OpticalDepth, depth_light: OpticalDepth) -> FurWeights:
    """Weights of hair and skin in a uniform coat whose hairs scatter the light once.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    returns      hair = integral of depth_view e^-((depth_view + depth_light) u) over 0 <= u <= 1 and skin =
                 e^-(depth_view + depth_light); hair + skin <= 1 up to rounding, and for depth_light = 0
                 hair is the opacity. skin is not below e^-80 = 1.8e-35
    degenerate   both depths 0: hair 0, skin 1
    form         hair = depth_view exprel_neg(depth_view + depth_light), with the exponential that skin
                 needs anyway. It depends on the ratio of the depths long after e^-x has vanished: limiting
                 them to the range of exp would be wrong by up to 0.49
    source       derived for this library: light and view cross independent gaps between the hairs; replaces
                 Goldman's rule, which is up to 0.48 too bright at grazing light or too dark at a grazing
                 view
    """
    depth = depth_view + depth_light
    clear = exp(-min(depth, EXP_LIMIT))
    series = exprel_series(min(depth, 0.7))
    mean = series if depth < 0.7 else (1.0 - clear) / max(depth, 0.7)
    return FurWeights(depth_view * mean, clear)


@variant("fur_weights_slab")
def fur_weights_slab_rational(depth_view: OpticalDepth, depth_light: OpticalDepth) -> FurWeights:
    """Weights of the uniform coat without an exponential and with one division.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    returns      the weights of fur_weights_slab to a fifth of half an 8-bit step; hair to 3.9e-4 relative
    form         with h = growth_rational(x) and x the sum of the depths: skin = 1 / (1 + x h) and hair =
                 depth_view h skin. hair + skin = 1 for depth_light = 0 by construction
    source       fitted for this library
    """
    depth = depth_view + depth_light
    growth = growth_rational(depth)
    skin = 1.0 / (1.0 + depth * growth)
    return FurWeights(depth_view * growth * skin, skin)


@variant("fur_weights_slab")
def fur_weights_slab_rational_coarse(depth_view: OpticalDepth, depth_light: OpticalDepth) -> FurWeights:
    """Weights of the uniform coat by a polynomial of low degree and one division: one percent.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    returns      the weights of fur_weights_slab to 1.1 percent of 1; hair to 1.1 percent relative
    form         fur_weights_slab_rational with growth_coarse
    source       fitted for this library
    """
    depth = depth_view + depth_light
    growth = growth_coarse(depth)
    skin = 1.0 / (1.0 + depth * growth)
    return FurWeights(depth_view * growth * skin, skin)
