"""On which side of a strand light and viewer are."""

from shaderlib.constants import TINY_SQUARE
from shaderlib.direction.doubled_cross import doubled_cross
from shaderlib.domains import Direction
from shaderlib.lang import clamp, cross, dot, f32, inverse_sqrt, max, variant

# The product of two squared sines would underflow from sines of 1e-9 each; scaled by powers of two it does
# not before they reach 1e-19 each, and it stays below overflow: 2^62 * 2^62.
SINE_SCALE = 1152921504606846976.0  # 2^60, for each squared length, and the root of both together


def strand_azimuth_cosine(t: Direction, l: Direction, v: Direction) -> f32:
    """Cosine kappa of the angle between light and viewer around a strand.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    returns     in [-1, 1]: 1 front-lit (l and v on one side of the strand), -1 back-lit
    degenerate  l or v along t (a sum-difference cross product is zero): 0. Accurate for sines from 1e-15
                each; below a product of sines of 2.4e-38 it fades to 0
    form        cosine between (t - l) x (t + l) and (t - v) x (t + v), which are 2 t x l and 2 t x v without
                cancellation, by one inverse root. Their inner product is written out: OpenCL promises its
                built-in relative to the longer of the two only. The cosine of plain cross products is 4e-4
                off at 1e-4 rad, the form (l.v - cos_l cos_v) / (sin_l sin_v) anything
    source      Goldman 1997, relative directionality; form derived for this library
    """
    a = doubled_cross(t, l)
    b = doubled_cross(t, v)
    squares = (SINE_SCALE * dot(a, a)) * (SINE_SCALE * dot(b, b))
    kappa = (SINE_SCALE * (a.x * b.x + a.y * b.y + a.z * b.z)) * inverse_sqrt(max(squares, TINY_SQUARE))
    return clamp(kappa, -1.0, 1.0)


@variant("strand_azimuth_cosine")
def strand_azimuth_cosine_cross(t: Direction, l: Direction, v: Direction) -> f32:
    """Cosine of the angle between light and viewer around a strand, by plain cross products.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    returns     in [-1, 1]: 1 front-lit, -1 back-lit
    degenerate  l or v along t: 0 for exact equality, otherwise what rounding leaves of the direction
    form        (t x l).(t x v) by one inverse root; the products cancel near the strand's axis
    source      Goldman 1997, relative directionality
    """
    a = cross(t, l)
    b = cross(t, v)
    squares = (SINE_SCALE * dot(a, a)) * (SINE_SCALE * dot(b, b))
    kappa = (SINE_SCALE * dot(a, b)) * inverse_sqrt(max(squares, TINY_SQUARE))
    return clamp(kappa, -1.0, 1.0)


@variant("strand_azimuth_cosine")
def strand_azimuth_cosine_dots(t: Direction, l: Direction, v: Direction) -> f32:
    """Cosine of the angle between light and viewer around a strand, from three inner products.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    returns     in [-1, 1]: 1 front-lit, -1 back-lit; meaningless within 1e-3 rad of the strand's axis
    degenerate  l or v along t: what rounding leaves, in [-1, 1]
    form        (l.v - cos_l cos_v) / (sin_l sin_v) by one inverse root: everything cancels near the axis
    source      Goldman 1997, relative directionality
    """
    cos_l = dot(t, l)
    cos_v = dot(t, v)
    squares = (1.0 - cos_l * cos_l) * (1.0 - cos_v * cos_v)
    return clamp((dot(l, v) - cos_l * cos_v) * inverse_sqrt(max(squares, TINY_SQUARE)), -1.0, 1.0)
