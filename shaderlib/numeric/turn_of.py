"""Angle of a point as a share of a full turn."""

from typing import Annotated

from shaderlib.constants import SMALLEST_NORMAL
from shaderlib.lang import Interval, abs, f32, helper, max, min

# Minimax in the relative error of atan(q) / (2 pi) on |q| <= tan(pi / 8): 1.8e-8, in odd powers of q.
TURN_1 = 0.159154937  # 3e22f983
TURN_3 = -0.0530507974  # bd594bcb
TURN_5 = 0.0317903534  # 3d02369a
TURN_7 = -0.0220462531  # bcb49a58
TURN_9 = 0.0127112195  # 3c5042b8

# tan(pi / 8)
TAN_SIXTEENTH = 0.414213562373095049


@helper
def turn_of(
    y: Annotated[f32, Interval(-1.0e30, 1.0e30)], x: Annotated[f32, Interval(-1.0e30, 1.0e30)]
) -> f32:
    """Angle of the point (x, y) from the x axis as a share of a full turn: atan2(y, x) / (2 pi).

    y           second coordinate
    x           first coordinate
    returns     in [-1/2, 1/2], positive for y > 0; the relative error is flat as y -> 0 for x > 0
    degenerate  origin: 0; y = 0 and x < 0: 1/2, whatever the sign of the zero
    form        the quotient of the smaller by the larger coordinate, or of their difference by their sum,
                never exceeds tan(pi / 8), where five terms suffice. The built-in atan2 is undefined at the
                origin, depends on the sign of zero and is promised to 4096 ulp in WGSL
    source      tan(a - pi / 4) = (tan a - 1) / (tan a + 1); polynomial fitted for this library
    """
    a = abs(x)
    b = abs(y)
    low = min(a, b)
    high = max(a, b)
    steep = low > TAN_SIXTEENTH * high
    q = (low - high if steep else low) / max(low + high if steep else high, SMALLEST_NORMAL)
    s = q * q
    part = q * (TURN_1 + s * (TURN_3 + s * (TURN_5 + s * (TURN_7 + s * TURN_9))))
    octant = part + (0.125 if steep else 0.0)
    quadrant = 0.25 - octant if b > a else octant
    upper = 0.5 - quadrant if x < 0.0 else quadrant
    return -upper if y < 0.0 else upper
