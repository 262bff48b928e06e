"""Direction halfway between light and viewer."""

from shaderlib.direction.frame_from_normal import frame_from_normal
from shaderlib.domains import Direction
from shaderlib.lang import dot, inverse_sqrt, max, vec3

# l + v carries about 1e-7 of rounding, along any direction: below a length of 1e-6 it is noise.
OPPOSED_SQUARE = 1.0e-12


def half_vector(l: Direction, v: Direction) -> vec3:
    """Unit vector halfway between l and v.

    l           direction to the light
    v           direction to the viewer
    returns     (l + v) / |l + v|
    degenerate  l = -v, to |l + v| < 1e-6: frame_from_normal(l).tangent, orthogonal to l
    form        the rounding of l and v is amplified by 1 / |l + v|; below 1e-6 the sum may point along l
                itself, where the half vector is orthogonal to it
    source      elementary
    """
    total = l + v
    squared = dot(total, total)
    middle = inverse_sqrt(max(squared, OPPOSED_SQUARE)) * total
    return frame_from_normal(l).tangent if squared < OPPOSED_SQUARE else middle
