"""Goldman's weights of hair and skin."""

from shaderlib.constants import EXP_LIMIT
from shaderlib.domains import UnitInterval
from shaderlib.fakefur.domains import OpticalDepth
from shaderlib.fakefur.fur_weights import FurWeights
from shaderlib.lang import exp, min, variant
from shaderlib.numeric.exp_neg_powers import exp_neg_quadratic16
from shaderlib.numeric.exprel_series import exprel_series
from shaderlib.numeric.growth_rational import growth_coarse, growth_rational
from shaderlib.numeric.one_minus_exp_neg import one_minus_exp_neg_doubling_short

# Either depth is limited to half the range of exp, so that the product of the two transmittances is an
# ordinary number; e^-40 = 4e-18 is far below the last bit of the weights.
DEPTH_LIMIT = 0.5 * EXP_LIMIT


def fur_weights_goldman(
    depth_view: OpticalDepth, depth_light: OpticalDepth, overlap: UnitInterval
) -> FurWeights:
    """Weights of hair and skin by Goldman's rule: opacity along the view times shadow along the light.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    overlap      largest share of its light that a hair loses to the hairs above it; 0.5 by default
    returns      hair = (1 - e^-depth_view) (1 - overlap (1 - e^-depth_light)) and skin = e^-(depth_view +
                 depth_light), both in [0, 1]; skin is not below e^-80 = 1.8e-35
    form         two exponentials. Only the opacity along the view needs relative accuracy (thin coats), so
                 it alone has a polynomial below 0.7; the shadow is (1 - overlap) + overlap e^-depth_light,
                 where nothing cancels
    source       Goldman 1997, Fake Fur Rendering. The lecture takes the opacity along the view in all
                 places, which is wrong by up to 1 in the skin. The rule itself is up to 0.48 off the exact
                 slab, see fur_weights_slab
    """
    thin = min(depth_view, 0.7)
    clear_view = exp(-min(depth_view, DEPTH_LIMIT))
    clear_light = exp(-min(depth_light, DEPTH_LIMIT))
    opacity = thin * exprel_series(thin) if depth_view < 0.7 else 1.0 - clear_view
    hair = opacity * ((1.0 - overlap) + overlap * clear_light)
    return FurWeights(hair, clear_view * clear_light)


@variant("fur_weights_goldman")
def fur_weights_goldman_rational(
    depth_view: OpticalDepth, depth_light: OpticalDepth, overlap: UnitInterval
) -> FurWeights:
    """Goldman's weights without an exponential and with one division.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    overlap      largest share of its light that a hair loses to the hairs above it; 0.5 by default
    returns      the weights of fur_weights_goldman to 8e-4, less than half of half an 8-bit step
    form         with w(x) = x growth_rational(x), which imitates e^x - 1: skin = 1 / ((1 + w_view) (1 +
                 w_light)), hair = w_view (1 + (1 - overlap) w_light) skin. The slope of hair at depth_view
                 = 0 is exact, and skin = 1 - hair at depth_light = 0
    source       fitted for this library
    """
    growth_view = depth_view * growth_rational(depth_view)
    growth_light = depth_light * growth_rational(depth_light)
    skin = 1.0 / ((1.0 + growth_view) * (1.0 + growth_light))
    hair = growth_view * (1.0 + (1.0 - overlap) * growth_light) * skin
    return FurWeights(hair, skin)


@variant("fur_weights_goldman")
def fur_weights_goldman_doubling_short(
    depth_view: OpticalDepth, depth_light: OpticalDepth, overlap: UnitInterval
) -> FurWeights:
    """Goldman's weights without an exponential and without a division.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    overlap      largest share of its light that a hair loses to the hairs above it; 0.5 by default
    returns      the weights of fur_weights_goldman to 9e-4, less than half of half an 8-bit step
    form         opacities by one_minus_exp_neg_doubling_short, combined as Goldman writes it
    source       Goldman 1997, Fake Fur Rendering; fitted for this library
    """
    opacity_view = one_minus_exp_neg_doubling_short(depth_view)
    opacity_light = one_minus_exp_neg_doubling_short(depth_light)
    hair = opacity_view * (1.0 - overlap * opacity_light)
    return FurWeights(hair, (1.0 - opacity_view) * (1.0 - opacity_light))


@variant("fur_weights_goldman")
def fur_weights_goldman_quadratic16(
    depth_view: OpticalDepth, depth_light: OpticalDepth, overlap: UnitInterval
) -> FurWeights:
    """Goldman's weights from transmittances that are sixteenth powers: no exponential, no division.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    overlap      largest share of its light that a hair loses to the hairs above it; 0.5 by default
    returns      the weights of fur_weights_goldman to 5e-4, a quarter of half an 8-bit step
    form         squares of a quadratic, as coat_transmittance_quadratic16, in place of doublings of its
                 difference from 1: half the operations. A thin coat has an absolute error only
    source       Goldman 1997, Fake Fur Rendering; fitted for this library
    """
    clear_view = exp_neg_quadratic16(depth_view)
    clear_light = exp_neg_quadratic16(depth_light)
    hair = (1.0 - clear_view) * ((1.0 - overlap) + overlap * clear_light)
    return FurWeights(hair, clear_view * clear_light)


@variant("fur_weights_goldman")
def fur_weights_goldman_rational_coarse(
    depth_view: OpticalDepth, depth_light: OpticalDepth, overlap: UnitInterval
) -> FurWeights:
    """Goldman's weights by polynomials of low degree and one division: one percent.

    depth_view   optical depth of the coat along the view
    depth_light  optical depth of the coat along the light
    overlap      largest share of its light that a hair loses to the hairs above it; 0.5 by default
    returns      the weights of fur_weights_goldman to 1.5 percent of 1
    form         fur_weights_goldman_rational with growth_coarse
    source       fitted for this library
    """
    growth_view = depth_view * growth_coarse(depth_view)
    growth_light = depth_light * growth_coarse(depth_light)
    skin = 1.0 / ((1.0 + growth_view) * (1.0 + growth_light))
    hair = growth_view * (1.0 + (1.0 - overlap) * growth_light) * skin
    return FurWeights(hair, skin)
