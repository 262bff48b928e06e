"""e^-x as the sixteenth power of a polynomial: absolute error only, neither exponential nor division."""

from shaderlib.domains import NonNegative
from shaderlib.lang import f32, helper, min

# Minimax in the absolute error against e^-x; x is held at the limit, where both are below the error.
# (1 + x (c1 + x c2))^16: 2.2e-4
QUADRATIC16_1 = -0.0623984113  # bd7f957a
QUADRATIC16_2 = 0.00180275296  # 3aec4a5a
QUADRATIC16_LIMIT = 17.0


@helper
def exp_neg_quadratic16(x: NonNegative) -> f32:
    """e^-x as the sixteenth power of a quadratic.

    x        at least 0
    returns  e^-x to 2.3e-4 absolute, in (0, 1]
    form     four squarings
    source   fitted for this library
    """
    y = min(x, QUADRATIC16_LIMIT)
    r = 1.0 + y * (QUADRATIC16_1 + y * QUADRATIC16_2)
    r2 = r * r
    r4 = r2 * r2
    r8 = r4 * r4
    return r8 * r8
