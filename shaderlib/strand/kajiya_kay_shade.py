"""Free strands."""

from shaderlib.domains import Colour, Direction, Exponent
from shaderlib.lang import vec3
from shaderlib.numeric.pow_one_minus import pow_one_minus
from shaderlib.strand.strand_angles import strand_angles


def kajiya_kay_shade(
    t: Direction, l: Direction, v: Direction, k_diffuse: Colour, k_specular: Colour, exponent: Exponent
) -> vec3:
    """Light reflected by a free strand, after Kajiya and Kay.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    k_diffuse   diffuse colour, linear RGB
    k_specular  specular colour, linear RGB
    exponent    sharpness of the highlight, in [0, 1e5]
    returns     k_diffuse strand_diffuse + k_specular strand_specular; multiply by the colour of the light
    form        strand_angles once for both terms; the power through the defect, see strand_specular
    source      Kajiya and Kay 1989, diffuse and specular components
    """
    angles = strand_angles(t, l, v)
    return angles.sin_l * k_diffuse + pow_one_minus(angles.defect, exponent) * k_specular
