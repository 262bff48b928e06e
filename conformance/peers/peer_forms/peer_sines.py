"""Sines as other libraries write them."""

from shaderlib.domains import Direction
from shaderlib.lang import dot, f32, sqrt, variant


@variant("sin_angle")
def peer_sine_unclamped(a: Direction, b: Direction) -> f32:
    """Sine of the angle between two directions, as TressFX 4.1 writes it: without a clamp.

    a           first direction
    b           second direction
    returns     sine of the angle; undefined where rounding makes a.b exceed 1
    degenerate  a along b: the root of a negative number for one in some hundred pairs
    form        sqrt(1 - (a.b)^2)
    source      the formula of the strand lighting of TressFX 4.1, written anew
    """
    d = dot(a, b)
    return sqrt(1.0 - d * d)
