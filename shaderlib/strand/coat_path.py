"""Length of the way of light through a coat, under two readings of its geometry."""

from shaderlib.constants import COAT_LIMIT
from shaderlib.direction.sin_angle import sin_angle, sin_angle_cross, sin_angle_half
from shaderlib.domains import Depth, Direction
from shaderlib.lang import dot, f32, max, min, variant

# A depth of at most 1e6 divided by this is still finite; any depth that matters, from 1e-12 on, already
# saturates at COAT_LIMIT.
GRAZING = 1.0e-30


def coat_path_banks(depth: Depth, t: Direction, l: Direction) -> f32:
    """Way of light through a coat of strands that lie along the surface, as the lecture writes it.

    depth       distance below the OUTER boundary of the coat, at least 0, in scene units
    t           strand tangent, root to tip
    l           direction to the light
    returns     depth / sin(t, l), at most 1e18, in scene units
    degenerate  depth 0: 0; light along the strand: 1e18 for a depth from 1e-12 on
    form        right only where the strands lie in the surface and light falls across them: for hair that
                stands up use coat_path_slab
    source      Banks 1994, vector field shadowing; lecture VGP352 week 6
    """
    return min(depth / max(sin_angle(t, l), GRAZING), COAT_LIMIT)


def coat_path_slab(depth: Depth, n: Direction, l: Direction) -> f32:
    """Way of light through a coat that is a flat layer over the surface.

    depth       distance below the OUTER boundary of the coat, at least 0, in scene units
    n           surface normal
    l           direction to the light
    returns     depth / n.l, at most 1e18, in scene units
    degenerate  depth 0: 0; light in or below the surface (n.l <= 0): 1e18 for a depth from 1e-12 on
    form        the divisor is kept above 1e-30, where the quotient has saturated
    source      path through a parallel slab
    """
    return min(depth / max(dot(n, l), GRAZING), COAT_LIMIT)


@variant("coat_path_banks")
def coat_path_banks_half(depth: Depth, t: Direction, l: Direction) -> f32:
    """Way of light through a coat of strands that lie along the surface, for light off the strand's axis.

    depth       distance below the OUTER boundary of the coat, at least 0, in scene units
    t           strand tangent, root to tip
    l           direction to the light
    returns     depth / sin(t, l), at most 1e18, in scene units
    degenerate  depth 0: 0; light along the strand: from depth 1e7 up to 1e18, as rounding has it
    form        coat_path_banks with sin_angle_half
    source      Banks 1994, vector field shadowing; sin_angle_half
    """
    return min(depth / max(sin_angle_half(t, l), GRAZING), COAT_LIMIT)


@variant("coat_path_banks")
def coat_path_banks_cross(depth: Depth, t: Direction, l: Direction) -> f32:
    """Way of light through a coat of strands that lie along the surface, for light off the strand's axis.

    depth       distance below the OUTER boundary of the coat, at least 0, in scene units
    t           strand tangent, root to tip
    l           direction to the light
    returns     depth / sin(t, l), at most 1e18, in scene units
    degenerate  depth 0: 0; light along the strand: from depth 1e7 up to 1e18, as rounding has it
    form        coat_path_banks with sin_angle_cross
    source      Banks 1994, vector field shadowing; sin_angle_cross
    """
    return min(depth / max(sin_angle_cross(t, l), GRAZING), COAT_LIMIT)
