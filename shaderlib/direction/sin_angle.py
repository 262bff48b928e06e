"""Sine of the angle between two directions."""

from shaderlib.direction.doubled_cross import doubled_cross
from shaderlib.domains import Direction
from shaderlib.lang import cross, dot, f32, max, sqrt, variant


def sin_angle(a: Direction, b: Direction) -> f32:
    """Sine of the angle between two directions, with flat relative error at every angle.

    a           first direction
    b           second direction
    returns     sine of the angle, in [0, 1] up to rounding
    degenerate  a = b and a = -b: 0
    form        |(a - b) x (a + b)| / 2: half the length of doubled_cross, which cannot cancel.
                sqrt(1 - (a.b)^2) is 31 percent off at 1e-3 rad, |a x b| at 1e-7 rad
    source      identity derived for this library; the sine: Kajiya and Kay 1989, diffuse component
    """
    doubled = doubled_cross(a, b)
    return 0.5 * sqrt(dot(doubled, doubled))


@variant("sin_angle")
def sin_angle_half(a: Direction, b: Direction) -> f32:
    """Sine of the angle between two directions by half angles: one root, good to 1e-4 rad.

    a           first direction
    b           second direction
    returns     sine of the angle, in [0, 1] up to rounding
    degenerate  a = b and a = -b: 0
    form        2 sin(x / 2) cos(x / 2) with |a - b| = 2 sin(x / 2) and |a + b| = 2 cos(x / 2). Both lengths
                need unit vectors: rounding of their lengths is amplified below 1e-4 rad
    source      double-angle formula
    """
    difference = a - b
    total = a + b
    return 0.5 * sqrt(dot(difference, difference) * dot(total, total))


@variant("sin_angle")
def sin_angle_cross(a: Direction, b: Direction) -> f32:
    """Sine of the angle between two directions by their cross product.

    a           first direction
    b           second direction
    returns     sine of the angle, in [0, 1] up to rounding
    degenerate  a = b and a = -b: 0, up to a rounding error of 1e-7
    form        |a x b|; each component cancels for nearly parallel directions: about 1e-7 absolute
    source      elementary
    """
    product = cross(a, b)
    return sqrt(dot(product, product))


@variant("sin_angle")
def sin_angle_cosine(a: Direction, b: Direction) -> f32:
    """Sine of the angle between two directions by their cosine: the obvious form.

    a           first direction
    b           second direction
    returns     sine of the angle, in [0, 1]
    degenerate  a = b and a = -b: 0 up to 9e-4
    form        sqrt(1 - (a.b)^2), with the difference clamped because float32 unit vectors may have a.b > 1.
                It cancels for nearly parallel directions: 31 percent off at 1e-3 rad
    source      elementary
    """
    c = dot(a, b)
    return sqrt(max(1.0 - c * c, 0.0))
