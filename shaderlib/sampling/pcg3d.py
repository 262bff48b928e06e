"""Three-dimensional integer hash."""

from typing import Annotated

from shaderlib.lang import Finite, uvec3


def pcg3d(x: Annotated[uvec3, Finite()]) -> uvec3:
    """Hash of three integers to three, each of which depends on all; a bijection.

    x        any three numbers, for instance a cell and a seed
    returns  three times 32 well-mixed bits (the upper ones are better); (1, 2, 3) gives fa9f79a6 48f2f44c
             596f5ab1
    form     integers only, so every target agrees
    source   Jarzynski and Olano 2020, Hash Functions for GPU Rendering
    """
    a0 = x.x * 1664525 + 1013904223
    b0 = x.y * 1664525 + 1013904223
    c0 = x.z * 1664525 + 1013904223
    a1 = a0 + b0 * c0
    b1 = b0 + c0 * a1
    c1 = c0 + a1 * b1
    a2 = a1 ^ (a1 >> 16)
    b2 = b1 ^ (b1 >> 16)
    c2 = c1 ^ (c1 >> 16)
    a3 = a2 + b2 * c2
    b3 = b2 + c2 * a3
    c3 = c2 + a3 * b3
    return uvec3(a3, b3, c3)
