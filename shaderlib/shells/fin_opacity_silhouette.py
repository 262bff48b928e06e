"""Opacity of a fin by how close its edge is to the silhouette."""

from shaderlib.domains import Cosine, UnitInterval
from shaderlib.lang import abs, clamp, f32, max, min

# Narrowest fade; a threshold of 0 shows the fins of true silhouette edges only.
NARROWEST_FADE = 1.0e-6


def fin_opacity_silhouette(facing_a: Cosine, facing_b: Cosine, threshold: UnitInterval) -> f32:
    """Opacity of a fin from the two faces that share its edge.

    facing_a    cosine between the direction to the viewer and the normal of one face
    facing_b    the same for the other face
    threshold   cosine up to which fins are visible; counts as 1e-6 below that
    returns     1 where one face is turned away and the other is not; otherwise it falls linearly, to 0
                where the more grazing of the two faces reaches the threshold
    form        continuous through the change of sign: the smaller cosine goes through 0 there. A product
                that vanishes in the rounding is such a small cosine
    source      Tariq 2007, Fur (using Shells and Fins), NVIDIA white paper
    """
    grazing = min(abs(facing_a), abs(facing_b)) / max(threshold, NARROWEST_FADE)
    return 1.0 if facing_a * facing_b <= 0.0 else clamp(1.0 - grazing, 0.0, 1.0)
