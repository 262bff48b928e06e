"""Function that imitates (e^x - 1) / x, for rational forms of e^-x."""

from shaderlib.domains import NonNegative
from shaderlib.lang import f32, helper, min

# Minimax in the relative error of 1 - (1 + u)^-4 against 1 - e^-x, u = x (1/4 + x (GROWTH_2 + x GROWTH_3)):
# 3.94e-4, which bounds the absolute error of both.
GROWTH_1 = 0.25
GROWTH_2 = 0.0306222197  # 3cfadb73
GROWTH_3 = 0.00340716727  # 3b5f4ac8

# The same for h = 1 + x (COARSE_2 + x COARSE_3): 1.05e-2.
COARSE_2 = 0.391099304  # 3ec83e2b
COARSE_3 = 0.370129526  # 3ebd819e

# e^-20 is 2e-9; holding the cubic there keeps x * growth finite for any x.
GROWTH_LIMIT = 20.0

# 1 / (1 + x h) is 4e-6 there.
COARSE_LIMIT = 88.0


@helper
def growth_rational(x: NonNegative) -> f32:
    """Function h for which x h(x) imitates e^x - 1.

    x        at least 0
    returns  h(x), with 1 / (1 + x h) = e^-x to 3.9e-4, x h / (1 + x h) = 1 - e^-x and h / (1 + x h) =
             (1 - e^-x) / x to 3.9e-4 relative; the first two add up to 1 by construction
    form     1 + x h is the fourth power of a cubic 1 + u; each squaring is w = u (2 + u), so that nothing is
             subtracted and h(0) = 1. A quintic without squarings errs by 8e-4
    source   fitted for this library
    """
    y = min(x, GROWTH_LIMIT)
    cubic = GROWTH_1 + y * (GROWTH_2 + y * GROWTH_3)
    u = y * cubic
    first = 2.0 + u
    return cubic * first * (2.0 + u * first)


@helper
def growth_coarse(x: NonNegative) -> f32:
    """Polynomial h for which x h(x) imitates e^x - 1, to one percent.

    x        at least 0
    returns  h(x), with 1 / (1 + x h) = e^-x to 7e-3, x h / (1 + x h) = 1 - e^-x and h / (1 + x h) =
             (1 - e^-x) / x to 1.1 percent; the first two add up to 1 by construction
    form     second degree, with h(0) = 1: exact slope at 0, monotone, right limits
    source   fitted for this library
    """
    y = min(x, COARSE_LIMIT)
    return 1.0 + y * (COARSE_2 + y * COARSE_3)
