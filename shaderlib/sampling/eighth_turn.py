"""Cosine and sine up to an eighth of a turn."""

from typing import Annotated

from shaderlib.lang import Interval, f32, helper, vec2

# Minimax in the relative error: sin(pi y / 4) / y to 3.5e-8 and cos(pi y / 4) to 1.1e-8, in powers of y^2.
SIN_0 = 0.785398185  # 3f490fdb
SIN_1 = -0.0807454363  # bda55ddd
SIN_2 = 0.00249000103  # 3b232f49
SIN_3 = -3.59504520e-05  # b816c981
COS_1 = -0.308425128  # be9de9e6
COS_2 = 0.0158543270  # 3c81e0ef
COS_3 = -0.000325940084  # b9aae2f0
COS_4 = 3.53033809e-06  # 366ceabf


@helper
def eighth_turn(y: Annotated[f32, Interval(-1.0, 1.0)]) -> vec2:
    """Point on the unit circle up to 45 degrees on either side of the x axis.

    y        angle in units of pi / 4, in [-1, 1]
    returns  (cos(pi y / 4), sin(pi y / 4))
    form     polynomials: the built-ins are promised to 2^-11 absolute in WGSL and to nothing in GLSL
    source   minimax polynomials fitted for this library
    """
    s = y * y
    sine = y * (SIN_0 + s * (SIN_1 + s * (SIN_2 + s * SIN_3)))
    cosine = 1.0 + s * (COS_1 + s * (COS_2 + s * (COS_3 + s * COS_4)))
    return vec2(cosine, sine)
