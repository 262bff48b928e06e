"""Scaled modified Bessel function of order zero."""

from typing import Annotated

from shaderlib.lang import Interval, abs, f32, min, sqrt, variant

P_0 = 1.00000048  # 3f800004
P_1 = 0.318277419  # 3ea2f542
P_2 = 0.283731401  # 3e91453e
P_3 = 0.096063897  # 3dc4bd26
P_4 = 0.0287491791  # 3ceb8366
P_5 = 0.00414608  # 3b87dbd7
P_6 = 0.00197814801  # 3b01a3d1
Q_1 = 2.31833196  # 40145f8d
Q_2 = 2.41947126  # 401ad89e
Q_3 = 1.47875202  # 3fbd47bf
Q_4 = 0.563838542  # 3f1057b9
Q_5 = 0.172661871  # 3e30ce46
Q_6 = 0.022946896  # 3cbbfb21
Q_7 = 0.0124290632  # 3c4ba345

SHORT_P_0 = 0.999568104
SHORT_P_1 = 0.388980567
SHORT_P_2 = 0.221233308
SHORT_P_3 = 0.189426929
SHORT_Q_1 = 2.36354232
SHORT_Q_2 = 2.69406748
SHORT_Q_3 = 1.04339828
SHORT_Q_4 = 1.1907202

COARSE_P_0 = 0.998965144  # 3f7fbc2e
COARSE_P_1 = 0.366092682  # 3ebb7080
COARSE_P_2 = 0.497826904  # 3efee32b
COARSE_Q_1 = 2.44991899  # 401ccb79
COARSE_Q_2 = 2.05528831  # 400389d8
COARSE_Q_3 = 3.11464405  # 40475654

# The fit holds to 2^17; x^7 is still far from overflow there.
LARGEST_ARGUMENT = 131072.0


def bessel_i0e(x: Annotated[f32, Interval(-1.0e5, 1.0e5)]) -> f32:
    """Scaled modified Bessel function e^-|x| I0(x), the normaliser of a wrapped Gaussian lobe.

    x        any sign; held at |x| = 131072 beyond
    returns  e^-|x| I0(x), in (0, 1]
    form     its square is close to 1 / (2 pi x) and fitted by one rational function over the whole range:
             no branch, no exponential, half the time of the two polynomials of Abramowitz and Stegun
    source   definition: Abramowitz and Stegun 1964, 9.6.16; rational function fitted for this library
    """
    m = min(abs(x), LARGEST_ARGUMENT)
    numerator = P_0 + m * (P_1 + m * (P_2 + m * (P_3 + m * (P_4 + m * (P_5 + m * P_6)))))
    tail = Q_3 + m * (Q_4 + m * (Q_5 + m * (Q_6 + m * Q_7)))
    denominator = 1.0 + m * (Q_1 + m * (Q_2 + m * tail))
    return sqrt(numerator / denominator)


@variant("bessel_i0e")
def bessel_i0e_short(x: Annotated[f32, Interval(-1.0e5, 1.0e5)]) -> f32:
    """Scaled modified Bessel function e^-|x| I0(x) to 2.2e-4, at half the cost.

    x        any sign; held at |x| = 131072 beyond
    returns  e^-|x| I0(x), in (0, 1]
    form     root of a rational function of degree 3 over 4
    source   definition: Abramowitz and Stegun 1964, 9.6.16; rational function fitted for this library
    """
    m = min(abs(x), LARGEST_ARGUMENT)
    numerator = SHORT_P_0 + m * (SHORT_P_1 + m * (SHORT_P_2 + m * SHORT_P_3))
    denominator = 1.0 + m * (SHORT_Q_1 + m * (SHORT_Q_2 + m * (SHORT_Q_3 + m * SHORT_Q_4)))
    return sqrt(numerator / denominator)


@variant("bessel_i0e")
def bessel_i0e_coarse(x: Annotated[f32, Interval(-1.0e5, 1.0e5)]) -> f32:
    """Scaled modified Bessel function e^-|x| I0(x) to 2.2e-3.

    x        any sign; held at |x| = 131072 beyond
    returns  e^-|x| I0(x), in (0, 1]
    form     root of a rational function of degree 2 over 3
    source   definition: Abramowitz and Stegun 1964, 9.6.16; rational function fitted for this library
    """
    m = min(abs(x), LARGEST_ARGUMENT)
    numerator = COARSE_P_0 + m * (COARSE_P_1 + m * COARSE_P_2)
    denominator = 1.0 + m * (COARSE_Q_1 + m * (COARSE_Q_2 + m * COARSE_Q_3))
    return sqrt(numerator / denominator)
