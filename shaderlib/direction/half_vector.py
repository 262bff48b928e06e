"""Direction halfway between light and viewer."""

from shaderlib.direction.frame_from_normal import frame_from_normal
from shaderlib.domains import Direction
from shaderlib.lang import clamp, dot, inverse_sqrt, max, variant, vec3

# l + v carries about 1e-7 of rounding, along any direction: below a length of 1e-6 it is noise.
OPPOSED_SQUARE = 1.0e-12

# Minimax in the relative error of 1 / sqrt(2 + 2 c) for c in [0, 1]: 4.8e-4.
ACUTE_0 = 0.706768095  # 3f34eec1
ACUTE_1 = -0.341655642  # beaeed7d
ACUTE_2 = 0.194440126  # 3e471b50
ACUTE_3 = -0.0597920679  # bd74e887


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


@variant("half_vector")
def half_vector_apart(l: Direction, v: Direction) -> vec3:
    """Unit vector halfway between l and v, where they are not opposite.

    l           direction to the light
    v           direction to the viewer
    returns     (l + v) / |l + v|
    degenerate  l = -v, to |l + v| < 1e-6: a vector shorter than 1, without meaning
    form        no frame to fall back to
    source      elementary
    """
    total = l + v
    return inverse_sqrt(max(dot(total, total), OPPOSED_SQUARE)) * total


@variant("half_vector")
def half_vector_acute(l: Direction, v: Direction) -> vec3:
    """Unit vector halfway between l and v that are at most a right angle apart, to 5e-4, without a root.

    l           direction to the light
    v           direction to the viewer; l.v >= 0
    returns     (l + v) / |l + v|; its length is right to 5e-4, its direction exact
    degenerate  l.v < 0: shorter than 1, down to 0 for l = -v
    form        1 / |l + v| = 1 / sqrt(2 + 2 l.v) as a cubic in l.v
    source      fitted for this library
    """
    c = clamp(dot(l, v), 0.0, 1.0)
    return (ACUTE_0 + c * (ACUTE_1 + c * (ACUTE_2 + c * ACUTE_3))) * (l + v)
