"""Mirror direction."""

from shaderlib.domains import Direction
from shaderlib.lang import dot, vec3


def mirror(l: Direction, n: Direction) -> vec3:
    """Reflection of l about n; both point away from the surface, and so does the result.

    l        direction to the light
    n        normal
    returns  2 (n.l) n - l
    form     the built-in reflect takes an incident direction instead. The lecture prints n - 2 (n.l) l, with
             n and l exchanged: also a unit vector, but 89 degrees off on average
    source   Phong 1975; lecture VGP352 week 6, corrected
    """
    return (2.0 * dot(n, l)) * n - l
