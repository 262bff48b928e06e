"""Concentric map of the square to the disc."""

from shaderlib.domains import UnitSquare
from shaderlib.lang import abs, max, vec2
from shaderlib.sampling.eighth_turn import eighth_turn

# Below every |2 u - 1| but 0 for float32 numbers u in [0, 1): the smallest of them is 2^-24.
HALF_STEP = 2.9802322387695312e-8  # 2^-25


def disk_concentric(u: UnitSquare) -> vec2:
    """Uniform point in the unit disc; concentric squares become concentric circles.

    u           pair of uniform numbers in [0, 1)
    returns     point of length max(|2 u.x - 1|, |2 u.y - 1|), at most 1 up to rounding
    degenerate  u = (1/2, 1/2): the centre
    form        r is the larger coordinate a of 2 u - 1 and the angle pi/4 times the ratio b / a of both,
                which never leaves [-pi/4, pi/4]: eighth_turn, instead of built-ins without a promise
    source      Shirley and Chiu 1997, A Low Distortion Map Between Disk and Square
    """
    a = 2.0 * u - vec2(1.0)
    along_x = abs(a.x) > abs(a.y)
    larger = a.x if along_x else a.y
    smaller = a.y if along_x else a.x
    radius = abs(larger)
    direction = eighth_turn(smaller / max(radius, HALF_STEP))
    p = vec2(larger * direction.x, radius * direction.y)
    return p if along_x else p.yx
