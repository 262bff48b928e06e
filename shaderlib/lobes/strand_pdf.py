"""Strand lobe: density."""

from shaderlib.constants import INV_TWO_PI, ONE_BELOW
from shaderlib.domains import Direction, Exponent
from shaderlib.lang import abs, f32, length, max, min, sqrt, vec2
from shaderlib.lobes.strand_lobe_defect import strand_lobe_defect
from shaderlib.lobes.strand_mixture import strand_mixture
from shaderlib.numeric.log_one_minus import log_one_minus
from shaderlib.numeric.one_minus_exp_neg import one_minus_exp_neg
from shaderlib.numeric.pow_one_minus import pow_one_minus

# Replaces a defect of 0: far below any that distinct directions have, and still exact in every quotient.
SMALLEST_DEFECT = 1.0e-24

# Added to |sin(delta)| and to the sum of cosines, whose quotient is 1 where both vanish; far below the
# rounding of either elsewhere.
TINY_COSINE = 1.0e-15


def strand_pdf(l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Density with which strand_sample draws l, per steradian.

    l           direction to the light, in the local frame
    v           direction to the viewer, in the local frame
    exponent    p, sharpness of the lobe
    returns     H / (2 pi W), 0 where the strand cosine is not positive; integrates to 1 over the sphere. With
                m = p + 1, delta the sum of the elevations of l and v over the normal plane of x, c =
                cos(delta): H = m c^p (b |sin(delta)| + (1 - b) |sin(delta)| / (2 sqrt(1 - c^m))), b of
                strand_mixture; W = sum of the cosines of the elevations that +delta and -delta lead to
    degenerate  v = +-x and l = -v: the limit m / (2 pi)
    form        |sin(delta)| / sqrt(1 - c^m) is a root of two quantities that vanish together, both computed
                from the defect without cancellation: sqrt(2 / m) at the peak
    source      derived for this library
    """
    q = min(max(strand_lobe_defect(l, v), SMALLEST_DEFECT), ONE_BELOW)
    m = exponent + 1.0
    bell_slope = sqrt(q * (2.0 - q) / one_minus_exp_neg(-m * log_one_minus(q)))
    distance_l = length(vec2(l.y, l.z))
    distance_v = length(vec2(v.y, v.z))
    sine = l.x * distance_v + distance_l * v.x
    other = max((1.0 - q) * distance_v - v.x * sine, 0.0)
    share = strand_mixture(v, exponent)
    k = 1.0 / (distance_l + other + TINY_COSINE)
    shape = share.x * (abs(sine) + TINY_COSINE) * k + 0.5 * share.y * bell_slope * k
    pdf = INV_TWO_PI * m * pow_one_minus(q, exponent) * shape
    return pdf if q < ONE_BELOW else 0.0
