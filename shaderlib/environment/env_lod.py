"""Level at which a sample looks up an environment map."""

from shaderlib.domains import Direction
from shaderlib.environment.domains import MAP_BORDER, ParaboloidMap
from shaderlib.lang import f32, helper, texture_size
from shaderlib.maps.domains import Density, SampleCount
from shaderlib.maps.dual_paraboloid_solid_angle import dual_paraboloid_solid_angle
from shaderlib.maps.lod_from_pdf import lod_from_pdf


@helper
def env_lod(env: ParaboloidMap, w: Direction, pdf: Density, samples: SampleCount) -> f32:
    """Level of a dual-paraboloid map whose texels are as large as what one sample stands for.

    env      the map
    w        direction of the sample
    pdf      density of the sample per steradian
    samples  number of samples drawn
    returns  level, at least 0, possibly beyond the last
    form     lod_from_pdf without a bias, with the texel that shows w
    source   Colbert and Krivanek 2007, GPU-Based Importance Sampling, GPU Gems 3 chapter 20
    """
    size = texture_size(env).y
    return lod_from_pdf(pdf, samples, dual_paraboloid_solid_angle(w.z, size, size, MAP_BORDER), 0.0)
