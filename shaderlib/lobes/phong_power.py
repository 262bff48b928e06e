"""The unnormalised Phong lobe."""

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import dot, f32, helper, min, vec3
from shaderlib.numeric.pow_one_minus import pow_one_minus


@helper
def phong_power(l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Power max(0, l.r)^exponent around the mirror direction r = (-v.x, -v.y, v.z).

    l         direction to the light, in the local frame
    v         direction to the viewer, in the local frame
    exponent  sharpness of the lobe
    returns   in [0, 1] up to rounding; 0 for l.r <= 0, also with exponent = 0
    form      1 - l.r = |l - r|^2 / 2 for unit vectors: no cancellation at the peak, and of second order in
              the rounding of the lengths, which a high exponent would multiply
    source    Phong 1975
    """
    d = l - vec3(-v.x, -v.y, v.z)
    q = min(0.5 * dot(d, d), 2.0)
    return pow_one_minus(q, exponent) if q < 1.0 else 0.0
