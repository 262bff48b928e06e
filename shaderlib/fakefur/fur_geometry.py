"""What the shading of a coat needs of directions, each quantity once."""

from shaderlib.constants import TINY_SQUARE
from shaderlib.direction.doubled_cross import doubled_cross
from shaderlib.domains import Cosine, CosineDefect, Direction, UnitInterval
from shaderlib.fakefur.domains import OpticalDepth
from shaderlib.fakefur.fur_coat import FurCoat
from shaderlib.fakefur.fur_hair_area import fur_hair_area
from shaderlib.fakefur.fur_optical_depth import fur_slab_depth
from shaderlib.lang import clamp, dot, helper, inverse_sqrt, max, sqrt, struct
from shaderlib.strand.strand_azimuth_cosine import SINE_SCALE


@struct
class FurGeometry:
    """One light and the viewer as the hairs of a coat see them.

    sin_l           sine of the angle between hair and light
    azimuth_cosine  cosine of the angle between light and viewer around the hair
    defect          1 - strand cosine, see strand_angles
    n_dot_l         cosine between surface normal and light
    depth_view      optical depth of the coat along the view
    depth_light     optical depth of the coat along the light
    """

    sin_l: UnitInterval
    azimuth_cosine: Cosine
    defect: CosineDefect
    n_dot_l: Cosine
    depth_view: OpticalDepth
    depth_light: OpticalDepth


@helper
def fur_geometry(coat: FurCoat, t: Direction, n: Direction, l: Direction, v: Direction) -> FurGeometry:
    """Angles and optical depths of a coat for one light.

    coat        geometry of the coat
    t           hair direction, root to tip
    n           surface normal
    l           direction to the light
    v           direction to the viewer
    returns     see FurGeometry; the values are those of strand_angles, strand_azimuth_cosine and
                fur_optical_depth
    degenerate  t = +-l or t = +-v: that sine, its depth and the azimuth cosine are 0
    form        doubled_cross keeps its relative accuracy at every angle, and with both cross products at
                hand sines, azimuth and defect cost less than from cosines, which lose everything near the
                hair
    source      Goldman 1997, Fake Fur Rendering; forms derived for this library
    """
    across_l = doubled_cross(t, l)
    across_v = doubled_cross(t, v)
    square_l = dot(across_l, across_l)
    square_v = dot(across_v, across_v)
    sin_l = 0.5 * sqrt(square_l)
    sin_v = 0.5 * sqrt(square_v)
    # Scaled by powers of two as in strand_azimuth_cosine: the product would vanish from sines of 1e-9 on.
    squares = (SINE_SCALE * square_l) * (SINE_SCALE * square_v)
    together = across_l.x * across_v.x + across_l.y * across_v.y + across_l.z * across_v.z
    azimuth_cosine = (SINE_SCALE * together) * inverse_sqrt(max(squares, TINY_SQUARE))
    sine_gap = sin_l - sin_v
    cosine_sum = dot(t, l + v)
    defect = 0.5 * (sine_gap * sine_gap + cosine_sum * cosine_sum)
    hair_cover = coat.density * fur_hair_area(coat.hair_length, coat.radius_base, coat.radius_tip)
    n_dot_l = dot(n, l)
    return FurGeometry(
        sin_l=sin_l,
        azimuth_cosine=clamp(azimuth_cosine, -1.0, 1.0),
        defect=defect,
        n_dot_l=n_dot_l,
        depth_view=fur_slab_depth(hair_cover, sin_v, dot(n, v)),
        depth_light=fur_slab_depth(hair_cover, sin_l, n_dot_l),
    )
