"""Mixture weights of the strand sampler."""

from shaderlib.constants import TWO_PI
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import helper, min, sqrt, vec2
from shaderlib.numeric.pow_one_minus import pow_one_minus


@helper
def strand_mixture(v: Direction, exponent: Exponent) -> vec2:
    """Shares of the two densities of delta that strand_sample mixes.

    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   (b, 1 - b): b = B / (s sqrt(2 pi / (p + 1.5)) + B) of a lobe that is 0 at delta = 0, as seen
              along the strand, with B = |v.x|^(p + 2) / (p + 1) and s the distance of v from the x axis; 1 -
              b of a bell
    form      any b gives an exact density, this one a nearly constant weight. |v.x| from s^2, both shares as
              quotients: neither cancels
    source    derived for this library
    """
    square = min(v.y * v.y + v.z * v.z, 1.0)
    lobe = pow_one_minus(square, 0.5 * exponent + 1.0) / (exponent + 1.0)
    bell = sqrt(square) * sqrt(TWO_PI / (exponent + 1.5))
    k = 1.0 / (bell + lobe)
    return vec2(lobe * k, bell * k)
