"""Square grids with bilinear interpolation, as sparse rows of a least-squares problem."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import sparse

from codegen.maps.bilinear import neighbours

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Taps:
    """Bilinear lookups of n points: texel numbers (n, 4) in row-major order and weights (n, 4)."""

    texels: npt.NDArray[np.int64]
    weights: Array


def taps(uv: Array, size: int) -> Taps:
    """Lookups at coordinates (n, 2) in [0, 1], texel centres at (k + 0.5) / size, clamped at the edge."""
    (left, right, fx), (top, bottom, fy) = (neighbours(c * size - 0.5, size) for c in uv.T)
    texels = np.stack([top * size + left, top * size + right, bottom * size + left, bottom * size + right])
    weights = np.stack([(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy])
    return Taps(texels.T, weights.T)


def rows(found: Taps, size: int) -> sparse.csr_array:
    """The lookups as a matrix (n, size * size)."""
    count = len(found.texels)
    at = np.repeat(np.arange(count), 4)
    return sparse.csr_array((found.weights.ravel(), (at, found.texels.ravel())), shape=(count, size * size))


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
