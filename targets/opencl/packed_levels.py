"""All levels of a map side by side in one image, each in a border that continues it; see lookup_level.cl."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from targets.textures import TextureData


def packed(texture: TextureData) -> npt.NDArray[np.float32]:
    """The image, (h + 2, sum of (w_k + 2), 4)."""
    bordered = [_bordered(level, texture) for level in texture.levels]
    height = bordered[0].shape[0]
    filled = [np.pad(b, ((0, height - b.shape[0]), (0, 0), (0, 0))) for b in bordered]
    return np.ascontiguousarray(np.concatenate(filled, axis=1), np.float32)


def layout(texture: TextureData) -> npt.NDArray[np.int32]:
    """Width, height, number of levels, edges: what lookup_level takes as its layout."""
    edges = int(texture.repeat_u) + 2 * int(texture.repeat_v)
    return np.array([*texture.size, len(texture.levels), edges], np.int32)


def _bordered(level: npt.NDArray[np.float32], texture: TextureData) -> npt.NDArray[np.float32]:
    rows = np.pad(level, ((1, 1), (0, 0), (0, 0)), mode="wrap" if texture.repeat_v else "edge")
    return np.pad(rows, ((0, 0), (1, 1), (0, 0)), mode="wrap" if texture.repeat_u else "edge")
