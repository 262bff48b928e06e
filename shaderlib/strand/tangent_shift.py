"""Tangent displaced along the normal, to move a highlight."""

from shaderlib.domains import Direction, TangentShift
from shaderlib.lang import vec3
from shaderlib.numeric.safe_normalize import safe_normalize_dot


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
