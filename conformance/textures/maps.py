"""Small maps that are hard on lookups, and places to look."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Level = npt.NDArray[np.float32]
SIZES = ((16, 8), (1, 1), (5, 3), (1, 7), (64, 32))
"""Width and height: powers of two, one texel, odd, one column, larger."""


def chain(width: int, height: int, levels: int, seed: int, *, hot: bool = False) -> list[Level]:
    """Random levels in [0, 1), every size half of the one before; hot: black but for one texel of 1e5."""
    rng = np.random.Generator(np.random.PCG64(seed))
    found = []
    for k in range(levels):
        h, w = max(height >> k, 1), max(width >> k, 1)
        level = np.zeros((h, w, 4)) if hot else rng.random((h, w, 4))
        if hot:
            level[h // 2, w // 2] = 1e5
        found.append(level.astype(np.float32))
    return found


def full_chain(width: int, height: int) -> int:
    """How many levels a map has down to one texel."""
    return max(width, height).bit_length()


def places(count: int, width: int, height: int, seed: int) -> dict[str, npt.NDArray[np.float32]]:
    """uv inside, outside, on the centres and on the edges of texels; levels between, on and beyond levels."""
    rng = np.random.Generator(np.random.PCG64(seed))
    inside = rng.random((count, 2))
    outside = rng.uniform(-3.0, 4.0, (count, 2))
    centres = (rng.integers(0, (width, height), (count, 2)) + 0.5) / (width, height)
    edges = rng.integers(-1, (width + 2, height + 2), (count, 2)) / (width, height)
    uv = np.concatenate([inside, outside, centres, edges])
    levels = np.concatenate(
        [rng.uniform(0.0, 8.0, 3 * count), rng.integers(0, 12, count // 2), np.zeros(count - count // 2)]
    )
    return {"uv": uv.astype(np.float32), "lod": rng.permutation(levels).astype(np.float32)}
