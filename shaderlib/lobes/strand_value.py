"""Strand lobe: value."""

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import f32
from shaderlib.lobes.strand_lobe_defect import strand_lobe_defect
from shaderlib.numeric.pow_one_minus import pow_one_minus


def strand_value(l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Highlight of a strand along x, on the whole sphere of l and v; not normalised.

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    exponent  p, sharpness of the lobe
    returns   max(0, strand cosine)^p, in [0, 1] up to rounding; 0 where the strand cosine is not positive,
              also with p = 0. Equals strand_specular((1, 0, 0), l, v, p) for p > 0. Reciprocal. Multiply by a
              k_s of at most 1 / 3.2 (p = 0), 1 / 1.42 (10), 1 / 0.50 (100), 1 / 0.050 (1e4) for an albedo of
              at most 1
    form      strand_lobe_defect and pow_one_minus
    source    Kajiya and Kay 1989, Rendering Fur with Three Dimensional Textures; Banks 1994
    """
    q = strand_lobe_defect(l, v)
    return pow_one_minus(q, exponent) if q < 1.0 else 0.0
