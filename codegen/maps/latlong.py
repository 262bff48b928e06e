"""Latitude-longitude maps: directions, coordinates, solid angles and bilinear lookups, in float64.

Row 0 is at the top (w.y = 1), u = 0.5 looks along -z; see `latlong_uv` of the library.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from codegen.maps.bilinear import lookup

Array = npt.NDArray[np.float64]


def directions(height: int, width: int) -> Array:
    """Unit directions of the texel centres, (height, width, 3)."""
    theta = np.pi * (np.arange(height) + 0.5)[:, None] / height
    phi = 2.0 * np.pi * ((np.arange(width) + 0.5)[None, :] / width - 0.5)
    x, z = np.sin(theta) * np.sin(phi), -np.sin(theta) * np.cos(phi)
    return np.stack([x, np.broadcast_to(np.cos(theta), x.shape), z], axis=-1)


def coordinates(w: Array) -> Array:
    """Coordinates (u, v) in [0, 1] of directions (..., 3)."""
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    u = 0.5 + np.arctan2(x, -z) / (2.0 * np.pi)
    return np.stack(
        [np.where((x == 0.0) & (z == 0.0), 0.5, u), np.arctan2(np.hypot(x, z), y) / np.pi], axis=-1
    )


def solid_angles(height: int, width: int) -> Array:
    """Exact solid angle of a texel in each row, (height,); all texels sum to 4 pi."""
    v = (np.arange(height) + 0.5) / height
    return np.asarray(4.0 * np.pi / width * np.sin(np.pi * v) * np.sin(np.pi / (2.0 * height)))


def bilinear(pixels: npt.NDArray[np.floating], uv: Array) -> Array:
    """Bilinear lookups at (..., 2) coordinates in a (height, width, channels) map; u wraps, v clamps."""
    return lookup(pixels, uv, repeat_u=True)
