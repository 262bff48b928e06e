"""Polynomial that imitates (e^x - 1) / x, for rational forms of e^-x."""

from shaderlib.domains import NonNegative
from shaderlib.lang import f32, helper, min

GROWTH_1 = 0.456409198  # 3ee9ae77
GROWTH_2 = 0.265889496  # 3e8822ab
GROWTH_4 = 0.0428231446  # 3d2f6752
GROWTH_MIDDLE = 0.912710547  # 3f69a766

# Above 88, e^-x is 0 to every digit; holding the polynomial there keeps x * growth finite for any x.
GROWTH_LIMIT = 88.0


@helper
def growth_rational(x: NonNegative) -> f32:
    """Polynomial h for which x h(x) imitates e^x - 1.

    x        at least 0
    returns  h(x), with 1 / (1 + x h) = e^-x to 6.5e-4, x h / (1 + x h) = 1 - e^-x to 6.5e-4 and
             h / (1 + x h) = (1 - e^-x) / x to 0.32 percent; the first two add up to 1 by construction
    form     fourth degree, with h(0) = 1: exact slope at 0, monotone, right limits. Written with a square, so
             that no term is negative and nothing divides by less than 1, however x is rounded
    source   fitted for this library
    """
    y = min(x, GROWTH_LIMIT)
    d = y - GROWTH_MIDDLE
    return 1.0 + y * (GROWTH_1 + y * (GROWTH_2 + GROWTH_4 * (d * d)))
