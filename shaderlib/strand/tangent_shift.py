"""Tangent displaced along the normal, to move a highlight."""

from shaderlib.domains import Direction, TangentShift
from shaderlib.lang import inverse_sqrt, variant, vec3
from shaderlib.numeric.safe_normalize import safe_normalize_dot, safe_normalize_nonzero


def tangent_shift(t: Direction, n: Direction, shift: TangentShift) -> vec3:
    """Strand tangent tilted toward the surface normal.

    t           strand tangent, root to tip
    n           surface normal
    shift       displacement along n; with t from root to tip a positive shift moves the highlight toward the
                tip, a negative one toward the root (widely copied code says the opposite)
    returns     normalize(t + shift n)
    degenerate  t + shift n = 0 (t along n, shift of 1 or -1): t
    form        the highlight lies where t'.h = 0, so t.h = -shift n.h there
    source      Scheuermann 2004, Practical Real-Time Hair Rendering and Shading
    """
    return safe_normalize_dot(t + shift * n, t)


@variant("tangent_shift")
def tangent_shift_apart(t: Direction, n: Direction, shift: TangentShift) -> vec3:
    """Strand tangent tilted toward the surface normal, where the sum is not zero.

    t           strand tangent, root to tip
    n           surface normal
    shift       displacement along n; positive moves the highlight toward the tip
    returns     normalize(t + shift n)
    degenerate  t + shift n = 0: the zero vector
    form        no test: it is never zero for |shift| <= 0.5 or for t off the line of n
    source      Scheuermann 2004, Practical Real-Time Hair Rendering and Shading
    """
    return safe_normalize_nonzero(t + shift * n, t)


@variant("tangent_shift")
def tangent_shift_orthogonal(t: Direction, n: Direction, shift: TangentShift) -> vec3:
    """Strand tangent tilted toward a surface normal that is orthogonal to it.

    t           strand tangent, root to tip; orthogonal to n
    n           surface normal
    shift       displacement along n; positive moves the highlight toward the tip
    returns     normalize(t + shift n)
    degenerate  t not orthogonal to n: the length is off by about n.t, the direction exact
    form        |t + shift n|^2 = 1 + shift^2: the same for all points where the shift is
    source      Scheuermann 2004, Practical Real-Time Hair Rendering and Shading
    """
    return inverse_sqrt(1.0 + shift * shift) * (t + shift * n)
