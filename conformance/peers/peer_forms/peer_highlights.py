"""Strand highlights as other libraries write them. Their pow is exp2(p log2 x), as hardware computes it."""

from shaderlib.domains import Direction, Exponent
from shaderlib.lang import abs, clamp, dot, exp2, f32, log2, max, sqrt, variant

# Smallest base of the power: FLT_EPSILON.
SMALLEST_BASE = 1.1920929e-7


@variant("strand_specular")
def peer_highlight_unclamped(t: Direction, l: Direction, v: Direction, exponent: Exponent) -> f32:
    """Specular lobe of a strand as TressFX 4.1 writes it, without its shift of the cone.

    t           strand tangent, root to tip
    l           direction to the light
    v           direction to the viewer
    exponent    sharpness of the highlight
    returns     max(0, sin sin - cos cos)^exponent
    degenerate  l or v along t: the root of a negative number where rounding makes a cosine exceed 1; on the
                dark side the power of 0
    form        sines by sqrt(1 - cos^2) without a clamp, and the built-in power
    source      the formula of the strand lighting of TressFX 4.1, written anew
    """
    cos_l = dot(t, l)
    cos_v = dot(t, v)
    sin_l = sqrt(1.0 - cos_l * cos_l)
    sin_v = sqrt(1.0 - cos_v * cos_v)
    base = max(sin_l * sin_v - cos_l * cos_v, 0.0)
    return exp2(exponent * log2(base))


@variant("strand_specular_half")
def peer_highlight_half_power(t: Direction, h: Direction, exponent: Exponent) -> f32:
    """Half-vector lobe of a strand as Unity HDRP writes it, without its normaliser and its fade.

    t           strand tangent, root to tip
    h           half_vector of light and viewer
    exponent    sharpness of the highlight
    returns     (1 - (t.h)^2)^(exponent / 2)
    degenerate  h along t: a tiny number to the power
    form        the difference saturated, then the power of its size, at least FLT_EPSILON
    source      the formula of D_KajiyaKay in Unity's core library, written anew
    """
    d = dot(t, h)
    base = max(abs(clamp(1.0 - d * d, 0.0, 1.0)), SMALLEST_BASE)
    return exp2(0.5 * exponent * log2(base))
