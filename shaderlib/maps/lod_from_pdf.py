"""Mip level of a filtered importance sample."""

from typing import Annotated

from shaderlib.lang import Interval, f32, log2, max
from shaderlib.maps.domains import Density, SampleCount, SolidAngle

# Smallest ratio whose logarithm is taken; it stands for a density of 0 and gives level 49.8.
SMALLEST_RATIO = 1.0e-30


def lod_from_pdf(
    pdf: Density,
    samples: SampleCount,
    texel_solid_angle: SolidAngle,
    lod_bias: Annotated[f32, Interval(-16.0, 16.0)],
) -> f32:
    """Mip level whose texels cover as much as one sample stands for.

    pdf                density of the sample per steradian
    samples            number of samples drawn
    texel_solid_angle  solid angle of the finest texel there, in steradians
    lod_bias           levels to add; 0 is unbiased for the sequences of this library
    returns            max(0, lod_bias - log2(samples pdf texel_solid_angle) / 2); the caller clamps it to the
                       last level of its map
    degenerate         pdf = 0: 49.8 + lod_bias, finite
    form               the area of a sample is 1 / (samples pdf), and each level quadruples that of a texel
    source             Colbert and Krivanek 2007, GPU-Based Importance Sampling, GPU Gems 3 chapter 20
    """
    ratio = samples * pdf * texel_solid_angle
    return max(lod_bias - 0.5 * log2(max(ratio, SMALLEST_RATIO)), 0.0)
