"""Shadow that a surface casts on the strands that it carries."""

from shaderlib.domains import Direction
from shaderlib.lang import dot, f32, max


def inherited_shadow(n: Direction, l: Direction) -> f32:
    """Lambert's cosine of the carrying surface, which the strands inherit as self-shadowing.

    n        surface normal
    l        direction to the light
    returns  max(n.l, 0)
    form     strands alone are lit from both sides of the surface: their formulas are even in n.l
    source   Banks 1994, inherited self-shadowing; lecture VGP352 week 6
    """
    return max(dot(n, l), 0.0)
