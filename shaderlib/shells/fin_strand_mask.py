"""Procedural hairs for fin textures."""

from typing import Annotated

from shaderlib.domains import UnitInterval
from shaderlib.lang import Finite, Interval, f32, floor, helper, max, u32, vec2
from shaderlib.shells.shell_strand_mask import shell_strand_mask


@helper
def fin_strand_mask(
    along: Annotated[f32, Interval(-1024.0, 1024.0)],
    row: Annotated[f32, Interval(0.0, 512.0)],
    height: UnitInterval,
    density: Annotated[f32, Interval(1.0, 4096.0)],
    thickness: UnitInterval,
    seed: Annotated[u32, Finite()],
) -> f32:
    """Coverage of a fin texel by a row of hairs seen from the side.

    along      texture coordinate along the edge, in the unit of the shells' texture coordinates
    row        which row of hairs stands on this edge, a whole number
    height     height above the skin, 0 to 1
    density    hairs per unit of texture coordinates, as for the shells
    thickness  diameter of a hair at the skin, as a share of the distance between hairs
    seed       the coat's number
    returns    1 where one of three slices through the row meets a hair, at 1/4, 1/2 and 3/4 of its depth;
               0 elsewhere
    form       slices of shell_strand_mask, so that a fin shows the hairs of the same coat
    source     fin textures: Lengyel et al. 2001; this pattern was made for this library
    """
    cells = floor(max(density, 1.0))
    covered = 0.0
    for slice in range(3):
        depth = (row + 0.25 + 0.25 * f32(slice)) / cells
        covered = max(covered, shell_strand_mask(vec2(along, depth), height, density, thickness, seed))
    return covered
