"""Solid angle of a dual-paraboloid texel."""

from shaderlib.domains import Cosine
from shaderlib.lang import abs, f32
from shaderlib.maps.domains import Border, TexelCount


def dual_paraboloid_solid_angle(z: Cosine, width: TexelCount, height: TexelCount, border: Border) -> f32:
    """Solid angle of the texel that a direction falls into, for choosing its mip level.

    z        component w.z of the direction looked up
    width    texels of one half along u
    height   texels of one half along v
    border   half side of each square in units of the disc radius, at least 1
    returns  4 border^2 (1 + |z|)^2 / (width height) steradians. A sum over a map takes only texels inside the
             discs, 2 uv - 1 within 1 / border of 0: it is 4 pi to 1e-4 at 256 x 256
    form     Jacobian (1 + |z|)^2 of the map at the texel's centre
    source   Jacobian of the paraboloid map; Colbert and Krivanek 2007, GPU-Based Importance Sampling
    """
    depth = 1.0 + abs(z)
    scale = 2.0 * border * depth
    return (scale / width) * (scale / height)
