"""Outer product of two unit vectors without cancellation."""

from shaderlib.domains import Direction
from shaderlib.lang import helper, vec3


@helper
def doubled_cross(a: Direction, b: Direction) -> vec3:
    """Twice the outer product of two directions, with flat relative error at every angle.

    a        first direction
    b        second direction
    returns  2 a x b, of length 2 sin(a, b)
    form     (a - b) x (a + b), the same for any a and b. For unit vectors the factors are orthogonal and have
             one rounding per component, so the product cannot cancel; what lies along a (vectors are unit to
             float32 only) drops out. Written out, because OpenCL promises its built-in to 3.6e-7 of the
             largest components only, of which a small angle keeps nothing
    source   identity derived for this library
    """
    d = a - b
    s = a + b
    return vec3(d.y * s.z - d.z * s.y, d.z * s.x - d.x * s.z, d.x * s.y - d.y * s.x)
