"""Power of one minus a small number: the highlight of a lobe whose cosine is known by its defect."""

from shaderlib.constants import EXP_LIMIT, ONE_BELOW
from shaderlib.domains import CosineDefect, Exponent, ExponentFrom4, ExponentFrom8
from shaderlib.lang import clamp, exp, f32, max, min, variant
from shaderlib.numeric.log_one_minus import log_one_minus

# Minimax in the absolute error of exp(-2 p z (1 + a z^2 + b z^4)), over all p >= 4 at once.
FROM4_A = 0.325517029  # 3ea6aa2b
FROM4_B = 0.291213661  # 3e9519f5

# Minimax in the absolute error of exp(-p q (1 + a q + b q^2)), over all p >= 8 at once: 2.7e-4.
FROM8_A = 0.477103025  # 3ef446d9
FROM8_B = 0.524670482  # 3f0650ce

# The same with e^-y = (1 + c1 y + c2 y^2 + c3 y^3)^8 for y up to 9, held beyond: 1.7e-4.
CUBIC8_A = 0.477653623  # 3ef48f04
CUBIC8_B = 0.510274231  # 3f02a155
CUBIC8_1 = -0.125050768  # be000d4f
CUBIC8_2 = 0.0077821766  # 3bff01a1
CUBIC8_3 = -0.000284559064  # b99530df
CUBIC8_LIMIT = 9.0

# q / (2 - q) must not divide by zero at q = 2; everything is 0 to the last digit from 1 on.
LARGEST_DEFECT = 1.9


def pow_one_minus(q: CosineDefect, p: Exponent) -> f32:
    """Power (1 - q)^p, accurate as q -> 0 and for exponents up to 1e5.

    q           defect 1 - x of the base x, in [0, 2]; computed directly, not as 1 - x
    p           exponent, in [0, 1e5]
    returns     max(0, 1 - q)^p, in [0, 1] up to rounding; not below e^-80 = 1.8e-35 for q < 1
    degenerate  p = 0: 1, whatever q is; otherwise q >= 1: 0
    form        exp(p log_one_minus(q)). pow(1 - q, p) has lost q in the rounding of 1 - q, and p multiplies
                the loss: it errs by 1e-3 at p = 1e4 on measured drivers, 4e-3 as specifications permit
    source      log(1 - q) = -2 atanh(q / (2 - q))
    """
    inside = min(q, ONE_BELOW)
    power = exp(max(p * log_one_minus(inside), -EXP_LIMIT))
    return power if q < 1.0 or p <= 0.0 else 0.0


@variant("pow_one_minus")
def pow_one_minus_from4(q: CosineDefect, p: ExponentFrom4) -> f32:
    """Power (1 - q)^p for exponents from 4 on, without a logarithm.

    q        defect 1 - x of the base x, in [0, 2]
    p        exponent, in [4, 1e5]
    returns  max(0, 1 - q)^p to 6e-5 at p = 4, 1e-5 at 16, 4e-7 from 100 on; at most 2.5e-6 for q >= 1
    form     exp(-2 p z (1 + a z^2 + b z^4)), z = q / (2 - q): where a high power is not yet 0, z is small, so
             two terms fitted under the lobe replace the series of atanh
    source   fitted for this library over all p >= 4
    """
    inside = min(q, LARGEST_DEFECT)
    z = inside / (2.0 - inside)
    z_squared = z * z
    series = 1.0 + z_squared * (FROM4_A + z_squared * FROM4_B)
    return exp(max(-2.0 * p * z * series, -EXP_LIMIT))


@variant("pow_one_minus")
def pow_one_minus_gauss(q: CosineDefect, p: ExponentFrom8) -> f32:
    """Power (1 - q)^p by its first term: a third of a percent off at p = 8 and exact for large p.

    q        defect 1 - x of the base x, in [0, 2]
    p        exponent, in [8, 1e5]
    returns  max(0, 1 - q)^p to 0.112 / p^2; at most 1.2e-7 for q >= 1
    form     exp(-2 p z), z = q / (2 - q), with which log(1 - q) = -2 atanh(z) is odd: the error is
             0.112 / p^2, where exp(-p q) errs by 0.27 / p
    source   first term of atanh
    """
    inside = min(q, LARGEST_DEFECT)
    return exp(max(-2.0 * p * (inside / (2.0 - inside)), -EXP_LIMIT))


@variant("pow_one_minus")
def pow_one_minus_sq16(q: CosineDefect, p: ExponentFrom8) -> f32:
    """Power (1 - q)^p by four squarings and one division, without a transcendental function.

    q        defect 1 - x of the base x, in [0, 2]
    p        exponent, in [8, 1e5]; exact for p = 16
    returns  max(0, 1 - q)^p to 4.4e-4 from p = 16 on (a quarter of half an 8-bit step), 1.3e-3 at p = 8;
             0 for q >= 1 and p >= 16
    form     ((1 - s) / (1 + s))^16 with s = p z / 16 and z = q / (2 - q), both divisions joined into one;
             1 - q = (1 - z) / (1 + z), so it is the identity at p = 16
    source   derived for this library
    """
    d = 2.0 - q
    s = 0.0625 * p * q
    r = max((d - s) / (d + s), 0.0)
    r2 = r * r
    r4 = r2 * r2
    r8 = r4 * r4
    return r8 * r8


@variant("pow_one_minus")
def pow_one_minus_from8(q: CosineDefect, p: ExponentFrom8) -> f32:
    """Power (1 - q)^p for exponents from 8 on, by one exponential and without a division.

    q        defect 1 - x of the base x, in [0, 2]
    p        exponent, in [8, 1e5]
    returns  max(0, 1 - q)^p to 2.7e-4, a seventh of half an 8-bit step; at most 1e-7 for q >= 1
    form     exp(-p q (1 + a q + b q^2)): where a high power is not yet 0, q is small, so two terms fitted
             under the lobe replace the series of the logarithm
    source   fitted for this library over all p >= 8
    """
    inside = clamp(q, 0.0, 2.0)
    return exp(-min(p * inside * (1.0 + inside * (FROM8_A + inside * FROM8_B)), EXP_LIMIT))


@variant("pow_one_minus")
def pow_one_minus_cubic8(q: CosineDefect, p: ExponentFrom8) -> f32:
    """Power (1 - q)^p by three squarings of a cubic: no transcendental function, no division.

    q        defect 1 - x of the base x, in [0, 2]
    p        exponent, in [8, 1e5]
    returns  max(0, 1 - q)^p to 1.8e-4, an eleventh of half an 8-bit step, also for q >= 1
    form     with y = p q (1 + a q + b q^2), which imitates -p log(1 - q) under the lobe, e^-y as the eighth
             power of a cubic
    source   fitted for this library over all p >= 8
    """
    inside = clamp(q, 0.0, 2.0)
    y = min(p * inside * (1.0 + inside * (CUBIC8_A + inside * CUBIC8_B)), CUBIC8_LIMIT)
    r = 1.0 + y * (CUBIC8_1 + y * (CUBIC8_2 + y * CUBIC8_3))
    r2 = r * r
    r4 = r2 * r2
    return r4 * r4
