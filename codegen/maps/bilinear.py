"""Bilinear lookups in images on the host, in float64: the one place that weighs four texels.

Texel (i, j) of w by h lies at ((i + 1/2) / w, (j + 1/2) / h). Places are in texels, 0 at the first
centre. What a lookup means in an emitted function, rounded step by step, is in codegen/evaluate/textures.py.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.int64]


def neighbours(place: Array, size: int, *, repeats: bool = False) -> tuple[Index, Index, Array]:
    """Both texels about places along one axis, and the weight of the second.

    repeats  whether the first texel follows the last; else the outermost texels go on beyond their centres
    """
    held = place if repeats else np.clip(place, 0.0, size - 1.0)
    first = np.floor(held) if repeats else np.minimum(np.floor(held), max(size - 2, 0))
    below = first.astype(np.int64)
    if repeats:
        return below % size, (below + 1) % size, held - first
    return below, np.minimum(below + 1, size - 1), held - first


def at_places(pixels: npt.NDArray[np.floating], x: Array, y: Array, *, repeat_x: bool = False) -> Array:
    """Values (..., channels) of an image (height, width, channels) at places x, y (...) in texels."""
    height, width = pixels.shape[:2]
    left, right, fx = neighbours(x, width, repeats=repeat_x)
    top, bottom, fy = neighbours(y, height)
    source = pixels.astype(np.float64)
    fx, fy = fx[..., None], fy[..., None]
    above = source[top, left] * (1.0 - fx) + source[top, right] * fx
    below = source[bottom, left] * (1.0 - fx) + source[bottom, right] * fx
    return np.asarray(above * (1.0 - fy) + below * fy)


def lookup(pixels: npt.NDArray[np.floating], uv: Array, *, repeat_u: bool = False) -> Array:
    """Values (..., channels) at coordinates (..., 2); v ends at the edge, u too unless it repeats."""
    height, width = pixels.shape[:2]
    return at_places(pixels, uv[..., 0] * width - 0.5, uv[..., 1] * height - 0.5, repeat_x=repeat_u)
