"""Lambert lobe: density."""

from shaderlib.constants import INV_PI
from shaderlib.domains import Direction
from shaderlib.lang import f32, max


def lambert_pdf(l: Direction, v: Direction) -> f32:
    """Density with which lambert_sample draws l, per steradian.

    l        direction to the light, in the local frame
    v        direction to the viewer, in the local frame; without influence
    returns  max(l.z, 0) / pi; integrates to 1 over the sphere
    form     elementary
    source   Malley's method
    """
    return INV_PI * max(l.z, 0.0)
