"""Square grids with bilinear interpolation, as sparse rows of a least-squares problem and as lookups."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import sparse

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Taps:
    """Bilinear lookups of n points: texel numbers (n, 4) in row-major order and weights (n, 4)."""

    texels: npt.NDArray[np.int64]
    weights: Array


def taps(uv: Array, size: int) -> Taps:
    """Lookups at coordinates (n, 2) in [0, 1], texel centres at (k + 0.5) / size, clamped at the edge."""
    place = np.clip(uv * size - 0.5, 0.0, size - 1.0)
    corner = np.minimum(np.floor(place), max(size - 2, 0)).astype(np.int64)
    fx, fy = (place - corner).T
    x, y = corner.T
    right, below = np.minimum(x + 1, size - 1), np.minimum(y + 1, size - 1)
    texels = np.stack([y * size + x, y * size + right, below * size + x, below * size + right], axis=1)
    return Taps(texels, np.stack([(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy], axis=1))


def rows(found: Taps, size: int) -> sparse.csr_array:
    """The lookups as a matrix (n, size * size)."""
    count = len(found.texels)
    at = np.repeat(np.arange(count), 4)
    return sparse.csr_array((found.weights.ravel(), (at, found.texels.ravel())), shape=(count, size * size))


def lookup(image: Array, uv: Array) -> Array:
    """Bilinear lookups (n, channels) in an image (size, size, channels) at coordinates (n, 2)."""
    found = taps(uv, image.shape[0])
    flat = image.reshape(-1, image.shape[2])
    return np.asarray(np.einsum("nk,nkc->nc", found.weights, flat[found.texels]))


def bends(size: int) -> sparse.csr_array:
    """Second differences along both axes of a grid, (2 size (size - 2), size * size): 0 on planes."""
    if size < 3:
        return sparse.csr_array((0, size * size))
    number = np.arange(size * size).reshape(size, size)
    lines = [(number[:, :-2], number[:, 1:-1], number[:, 2:]), (number[:-2], number[1:-1], number[2:])]
    blocks = []
    for left, middle, right in lines:
        count = left.size
        at = np.tile(np.arange(count), 3)
        column = np.concatenate([left.ravel(), middle.ravel(), right.ravel()])
        value = np.repeat([1.0, -2.0, 1.0], count)
        blocks.append(sparse.csr_array((value, (at, column)), shape=(count, size * size)))
    return sparse.csr_array(sparse.vstack(blocks))
