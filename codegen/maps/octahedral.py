"""Octahedral maps: the sphere in one square, with a border of one texel that wraps around its edges."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from codegen.maps import latlong

Array = npt.NDArray[np.float64]


def points(size: int, offset: tuple[float, float] = (0.5, 0.5)) -> Array:
    """Coordinates uv in [0, 1] of the points at `offset` inside each texel, (size, size, 2)."""
    u, v = (np.arange(size) + offset[0]) / size, (np.arange(size) + offset[1]) / size
    return np.stack(np.meshgrid(u, v), axis=-1)


def directions(uv: Array) -> Array:
    """Unit directions of coordinates, (..., 3)."""
    unfolded = _unnormalised(uv)
    return np.asarray(unfolded / np.linalg.norm(unfolded, axis=-1, keepdims=True))


def _unnormalised(uv: Array) -> Array:
    p = 2.0 * uv - 1.0
    z = 1.0 - np.abs(p).sum(axis=-1)
    folded = (1.0 - np.abs(p[..., ::-1])) * np.where(p >= 0.0, 1.0, -1.0)
    return np.concatenate([np.where((z < 0.0)[..., None], folded, p), z[..., None]], axis=-1)


def solid_angles(size: int) -> Array:
    """Solid angle of each texel by its centre, (size, size): 4 / (size^2 |q|^3)."""
    return np.asarray(4.0 / (size**2 * np.linalg.norm(_unnormalised(points(size)), axis=-1) ** 3))


def from_latlong(pixels: npt.NDArray[np.floating], size: int, samples: int = 2) -> Array:
    """The octahedral map of a latitude-longitude map, (size, size, channels), without border."""
    offsets = (np.arange(samples) + 0.5) / samples
    total = np.zeros((size, size, pixels.shape[2]))
    for x in offsets:
        for y in offsets:
            w = directions(points(size, (float(x), float(y))))
            total += latlong.bilinear(pixels, latlong.coordinates(w))
    return total / samples**2


def bordered(level: Array) -> Array:
    """A level with one texel more on every side, (size + 2, size + 2, channels).

    Across an edge the map goes on mirrored along that edge; across a corner with the opposite corner.
    """
    size = level.shape[0]
    out = np.zeros((size + 2, size + 2, *level.shape[2:]))
    out[1:-1, 1:-1] = level
    out[0, 1:-1], out[-1, 1:-1] = level[0, ::-1], level[-1, ::-1]
    out[1:-1, 0], out[1:-1, -1] = level[::-1, 0], level[::-1, -1]
    out[0, 0], out[0, -1], out[-1, 0], out[-1, -1] = level[-1, -1], level[-1, 0], level[0, -1], level[0, 0]
    return out
