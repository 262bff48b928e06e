"""Mean transmittance of a uniform slab."""

from shaderlib.constants import EXP_LIMIT
from shaderlib.domains import NonNegative
from shaderlib.lang import exp, f32, max, min, variant
from shaderlib.numeric.exprel_series import exprel_series
from shaderlib.numeric.growth_rational import growth_coarse, growth_rational


def exprel_neg(x: NonNegative) -> f32:
    """Mean of e^-u over 0 <= u <= x, which is (1 - e^-x) / x.

    x           optical depth, at least 0
    returns     (1 - e^-x) / x, in (0, 1], with flat relative error
    degenerate  x = 0: 1
    form        polynomial below 0.7, the quotient above. (1 - exp(-x)) / x alone amplifies the rounding of
                exp without limit: llvmpipe returns up to 6e22 for tiny x
    source      elementary; series: exprel_series
    """
    series = exprel_series(min(x, 0.7))
    quotient = (1.0 - exp(-min(x, EXP_LIMIT))) / max(x, 0.7)
    return series if x < 0.7 else quotient


@variant("exprel_neg")
def exprel_neg_rational(x: NonNegative) -> f32:
    """Mean of e^-u over 0 <= u <= x as a ratio of polynomials: 0.04 percent, and cheap.

    x           optical depth, at least 0
    returns     (1 - e^-x) / x to 0.04 percent, in (0, 1]
    degenerate  x = 0: 1, by the same formula
    form        h / (1 + x h) with h = growth_rational(x): no exponential and no guard at 0
    source      fitted for this library
    """
    h = growth_rational(x)
    return h / (1.0 + x * h)


@variant("exprel_neg")
def exprel_neg_rational_coarse(x: NonNegative) -> f32:
    """Mean of e^-u over 0 <= u <= x as a ratio of polynomials of low degree: one percent.

    x           optical depth, at least 0
    returns     (1 - e^-x) / x to 1.1 percent, in (0, 1]
    degenerate  x = 0: 1, by the same formula
    form        h / (1 + x h) with h = growth_coarse(x): no exponential and no guard at 0
    source      fitted for this library
    """
    h = growth_coarse(x)
    return h / (1.0 + x * h)
