"""Lambert lobe: value."""

from shaderlib.constants import INV_PI
from shaderlib.domains import Direction
from shaderlib.lang import f32


def lambert_value(l: Direction, v: Direction) -> f32:
    """Reflectance of a white Lambert surface per steradian, without the cosine.

    l        direction to the light, in the local frame
    v        direction to the viewer, in the local frame
    returns  1 / pi above the surface; 0 for l.z <= 0 or v.z <= 0. Albedo 1
    form     constant
    source   Lambert 1760, Photometria
    """
    return INV_PI if l.z > 0.0 and v.z > 0.0 else 0.0
