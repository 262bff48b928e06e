"""Opacity of an optical depth."""

from shaderlib.constants import EXP_LIMIT
from shaderlib.domains import NonNegative
from shaderlib.lang import exp, f32, min, variant
from shaderlib.numeric.exprel_series import exprel_series
from shaderlib.numeric.growth_rational import growth_coarse, growth_rational

# (1 - e^-y) / y on [0, 17.33 / 16], minimax in the relative error.
DOUBLING_1 = -0.499994427  # beffff45
DOUBLING_2 = 0.166595891  # 3e2a981d
DOUBLING_3 = -0.0413684919  # bd297202
DOUBLING_4 = 0.00777084706  # 3bfea297
DOUBLING_5 = -0.000883175293  # ba6784e4

# 1 - e^-17.33 is 1 to half a step of float32.
DOUBLING_LIMIT = 17.33

# 1 - (1 - y (1/16 + SHORT_2 y))^16 with y = min(x, SHORT_LIMIT), minimax in the relative error: 4.4e-4.
SHORT_1 = 0.0625
SHORT_2 = -0.0018707728  # baf534b8
SHORT_LIMIT = 8.25


def one_minus_exp_neg(x: NonNegative) -> f32:
    """Opacity 1 - e^-x of the optical depth x, with flat relative error down to x = 1e-30.

    x           optical depth, at least 0
    returns     1 - e^-x, in [0, 1]
    degenerate  x = 0: 0
    form        polynomial below 0.7, the subtraction above, where it loses at most one bit. 1 - exp(-x) alone
                is 13 percent off at x = 1e-6 and noise below 1e-7
    source      elementary; series: exprel_series
    """
    thin = min(x, 0.7)
    series = thin * exprel_series(thin)
    difference = 1.0 - exp(-min(x, EXP_LIMIT))
    return series if x < 0.7 else difference


@variant("one_minus_exp_neg")
def one_minus_exp_neg_direct(x: NonNegative) -> f32:
    """Opacity 1 - e^-x as written: a small absolute error, no relative accuracy for thin coats.

    x        optical depth, at least 0
    returns  1 - e^-x, in [0, 1] up to rounding
    form     the subtraction; enough where the opacity is only blended with
    source   elementary
    """
    return 1.0 - exp(-min(x, EXP_LIMIT))


@variant("one_minus_exp_neg")
def one_minus_exp_neg_doubling(x: NonNegative) -> f32:
    """Opacity 1 - e^-x without a transcendental function or a branch, with flat relative error.

    x           optical depth, at least 0
    returns     1 - e^-x, in [0, 1]
    degenerate  x = 0: 0
    form        E(2 y) = E(y) (2 - E(y)) for E(y) = 1 - e^-y, four times from x / 16. No step amplifies a
                relative error, so the errors of the steps only add
    source      derived for this library
    """
    y = 0.0625 * min(x, DOUBLING_LIMIT)
    tail = DOUBLING_2 + y * (DOUBLING_3 + y * (DOUBLING_4 + y * DOUBLING_5))
    e1 = y * (1.0 + y * (DOUBLING_1 + y * tail))
    e2 = e1 * (2.0 - e1)
    e4 = e2 * (2.0 - e2)
    e8 = e4 * (2.0 - e4)
    return e8 * (2.0 - e8)


@variant("one_minus_exp_neg")
def one_minus_exp_neg_rational(x: NonNegative) -> f32:
    """Opacity 1 - e^-x as a ratio of polynomials: a fifth of half an 8-bit step, and cheap.

    x           optical depth, at least 0
    returns     1 - e^-x to 3.9e-4 relative, in [0, 1], monotone
    degenerate  x = 0: 0
    form        w / (1 + w) with w = x growth_rational(x): exact slope at 0 and the right limit
    source      fitted for this library
    """
    w = x * growth_rational(x)
    return w / (1.0 + w)


@variant("one_minus_exp_neg")
def one_minus_exp_neg_doubling_short(x: NonNegative) -> f32:
    """Opacity 1 - e^-x by four doublings of a quadratic: no exponential, no division, no branch.

    x           optical depth, at least 0
    returns     1 - e^-x to 4.5e-4 relative, in [0, 1]
    degenerate  x = 0: 0
    form        as one_minus_exp_neg_doubling, from a polynomial of degree 2 in place of 6
    source      fitted for this library
    """
    y = min(x, SHORT_LIMIT)
    e1 = y * (SHORT_1 + y * SHORT_2)
    e2 = e1 * (2.0 - e1)
    e4 = e2 * (2.0 - e2)
    e8 = e4 * (2.0 - e4)
    return e8 * (2.0 - e8)


@variant("one_minus_exp_neg")
def one_minus_exp_neg_rational_coarse(x: NonNegative) -> f32:
    """Opacity 1 - e^-x as a ratio of polynomials of low degree: one percent.

    x           optical depth, at least 0
    returns     1 - e^-x to 1.1 percent relative, in [0, 1], monotone
    degenerate  x = 0: 0
    form        w / (1 + w) with w = x growth_coarse(x): exact slope at 0 and the right limit
    source      fitted for this library
    """
    w = x * growth_coarse(x)
    return w / (1.0 + w)
