"""Silhouette area of a hair."""

from shaderlib.fakefur.domains import HairLength, HairRadius
from shaderlib.lang import f32, printed


def fur_hair_area(hair_length: HairLength, radius_base: HairRadius, radius_tip: HairRadius) -> f32:
    """Silhouette area of one hair, a truncated cone, seen from the side.

    hair_length  length of the hair
    radius_base  radius at the skin
    radius_tip   radius at the tip
    returns      area of the trapezoid with parallel sides 2 radius_base and 2 radius_tip, in that unit
                 squared
    form         one sum and one product, nothing cancels
    source       Goldman 1997, Fake Fur Rendering; rays shot at real cones confirm that the factor is 1, not
                 1/2
    """
    return hair_length * (radius_base + radius_tip)


@printed("fur_hair_area")
def fur_hair_area_printed(hair_length: HairLength, radius_base: HairRadius, radius_tip: HairRadius) -> f32:
    """Area of a hair as the lecture prints it: half the silhouette, right only if its radii mean diameters.

    hair_length  length of the hair
    radius_base  radius at the skin
    radius_tip   radius at the tip
    returns      hair_length (radius_base + radius_tip) / 2
    form         to the letter; a coat of half the density looks the same with fur_hair_area
    source       Romanick 2010, VGP352 week 6, "Fur Opacity"
    """
    return hair_length * (radius_base + radius_tip) * 0.5
