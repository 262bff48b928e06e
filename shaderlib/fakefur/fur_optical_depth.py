"""Optical depth of a coat along a direction."""

from typing import Annotated

from shaderlib.direction.sin_angle import sin_angle, sin_angle_cross, sin_angle_half
from shaderlib.domains import Cosine, Direction, UnitInterval
from shaderlib.fakefur.domains import HairArea, HairDensity
from shaderlib.fakefur.fur_obliquity import GRAZING
from shaderlib.lang import Interval, dot, f32, helper, max, min, variant

# Depth of an opaque coat. Far beyond what e^-x can tell apart, because the slab weights still depend on the
# ratio of two large depths.
OPAQUE = 1.0e9


# Silhouette area of the hairs on a unit of skin.
HairCover = Annotated[f32, Interval(0.0, 2.0e13, scale="log")]


@helper
def fur_slab_depth(hair_cover: HairCover, sine: UnitInterval, cosine: Cosine) -> f32:
    """Optical depth from quantities that a caller already has.

    hair_cover  hair area that stands on a unit of skin: density times area of a hair
    sine        sine of the angle between the direction and the hairs
    cosine      cosine of the angle between the direction and the surface normal
    returns     min(hair_cover sine / max(cosine, 1e-12), 1e9)
    form        the quotient stays below 2e25, so it is limited after the division, without a comparison
    source      Goldman 1997, Fake Fur Rendering
    """
    return min(hair_cover * sine / max(cosine, GRAZING), OPAQUE)


def fur_optical_depth(
    density: HairDensity, hair_area: HairArea, t: Direction, n: Direction, w: Direction
) -> f32:
    """Optical depth of a coat along a direction: the mean number of hairs that a ray meets.

    density     hairs per unit of skin area
    hair_area   silhouette area of one hair, see fur_hair_area
    t           hair direction
    n           surface normal
    w           direction to the light or to the viewer
    returns     x = density hair_area sin(w, t) / w.n in [0, 1e9]; e^-x of the rays reach the skin
    degenerate  w.n <= 0 counts as 1e-12: opaque; bald skin (density hair_area = 0) and w = t, w = -t give 0
    form        not limited to the range of e^-x: fur_weights_slab needs the ratio of two large depths.
                Continuous through w.n = 0. The relative error grows like 1e-7 / w.n
    source      Goldman 1997, Fake Fur Rendering; Romanick 2010, VGP352 week 6, "Fur Opacity"
    """
    return fur_slab_depth(density * hair_area, sin_angle(w, t), dot(w, n))


@variant("fur_optical_depth")
def fur_optical_depth_half(
    density: HairDensity, hair_area: HairArea, t: Direction, n: Direction, w: Direction
) -> f32:
    """Optical depth of a coat along a direction off the hairs.

    density     hairs per unit of skin area
    hair_area   silhouette area of one hair, see fur_hair_area
    t           hair direction
    n           surface normal
    w           direction to the light or to the viewer
    returns     x = density hair_area sin(w, t) / w.n in [0, 1e9]
    degenerate  w.n <= 0 counts as 1e-12: opaque; bald skin: 0
    form        fur_optical_depth with sin_angle_half
    source      Goldman 1997, Fake Fur Rendering; sin_angle_half
    """
    return fur_slab_depth(density * hair_area, sin_angle_half(w, t), dot(w, n))


@variant("fur_optical_depth")
def fur_optical_depth_cross(
    density: HairDensity, hair_area: HairArea, t: Direction, n: Direction, w: Direction
) -> f32:
    """Optical depth of a coat along a direction off the hairs.

    density     hairs per unit of skin area
    hair_area   silhouette area of one hair, see fur_hair_area
    t           hair direction
    n           surface normal
    w           direction to the light or to the viewer
    returns     x = density hair_area sin(w, t) / w.n in [0, 1e9]
    degenerate  w.n <= 0 counts as 1e-12: opaque; bald skin: 0
    form        fur_optical_depth with sin_angle_cross
    source      Goldman 1997, Fake Fur Rendering; sin_angle_cross
    """
    return fur_slab_depth(density * hair_area, sin_angle_cross(w, t), dot(w, n))
