"""Angle of a cosine as a share of half a turn."""

from shaderlib.domains import Cosine
from shaderlib.lang import abs, f32, helper, max, sqrt

# acos(a) / (pi sqrt(1 - a)) on [0, 1]: 1/2 at 0, minimax elsewhere, 3.4e-8 in the share.
ACOS_1 = -0.068307295  # bd8be4b2
ACOS_2 = 0.028283684  # 3ce7b32f
ACOS_3 = -0.015678875  # bc8070fc
ACOS_4 = 0.008860896  # 3c112d4b
ACOS_5 = -0.0038313232  # bb7b16f0
ACOS_6 = 0.00083129806  # 3a59eb78


@helper
def angle_share(c: Cosine) -> f32:
    """Angle whose sine is c, from -pi / 2 to pi / 2, as a coordinate from 0 to 1.

    c           cosine of the angle with an axis
    returns     asin(c) / pi + 1/2, in [0, 1]; 1/2 exactly at 0
    degenerate  |c| above 1 by rounding: 0 or 1
    form        sqrt(1 - |c|) times a polynomial: the root is all that is steep, and nothing cancels. The
                built-in asin is off by up to 3.9e-4 on common drivers
    source      Abramowitz and Stegun 1964, 4.4.45, for the form; polynomial fitted for this library
    """
    a = abs(c)
    high = ACOS_3 + a * (ACOS_4 + a * (ACOS_5 + a * ACOS_6))
    share = sqrt(max(1.0 - a, 0.0)) * (0.5 + a * (ACOS_1 + a * (ACOS_2 + a * high)))
    return 1.0 - share if c >= 0.0 else share
