"""Dual-paraboloid maps: two discs, front +z and back -z of the world, with a border around the rim.

Heidrich and Seidel 1998; the border (Colbert and Krivanek 2007) holds the true radiance of the directions
beyond the rim, so that filters near it stay on their own disc.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from codegen.maps import latlong

Array = npt.NDArray[np.float64]

SIZE = 256
BORDER = 1.2
FRONT, BACK = 1.0, -1.0


def points(size: int, border: float, offset: tuple[float, float] = (0.5, 0.5)) -> tuple[Array, Array]:
    """Disc coordinates s, t of the points at `offset` inside each texel, each (size, size)."""
    s = (2.0 * (np.arange(size) + offset[0]) / size - 1.0) * border
    t = (2.0 * (np.arange(size) + offset[1]) / size - 1.0) * border
    return np.broadcast_to(s[None, :], (size, size)), np.broadcast_to(t[:, None], (size, size))


def directions(s: Array, t: Array, side: float) -> Array:
    """Unit directions of disc coordinates on one side, (..., 3); beyond the rim z changes sign."""
    square = s * s + t * t
    scale = 2.0 / (1.0 + square)
    return np.stack([s * scale, t * scale, side * (1.0 - square) / (1.0 + square)], axis=-1)


def solid_angles(size: int, border: float) -> Array:
    """Solid angle of each texel, (size, size): that of its direction, also beyond the rim."""
    s, t = points(size, border)
    return (2.0 * border / size) ** 2 * (2.0 / (1.0 + s * s + t * t)) ** 2


def from_latlong(
    pixels: npt.NDArray[np.floating], size: int = SIZE, border: float = BORDER, samples: int = 2
) -> Array:
    """The two discs of a latitude-longitude map, (2, size, size, channels), front first.

    Each texel is the mean of samples x samples bilinear lookups spread over it.
    """
    offsets = (np.arange(samples) + 0.5) / samples
    discs = np.zeros((2, size, size, pixels.shape[2]))
    for k, side in enumerate((FRONT, BACK)):
        for x in offsets:
            for y in offsets:
                w = directions(*points(size, border, (float(x), float(y))), side)
                discs[k] += latlong.bilinear(pixels, latlong.coordinates(w))
    return discs / samples**2
