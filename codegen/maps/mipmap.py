"""Chains of ever smaller images, each texel the mean of what it covers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from codegen.maps import latlong

Array = npt.NDArray[np.float64]


def chain(level: npt.ArrayLike, weights: npt.ArrayLike | None = None, least: int = 1) -> list[Array]:
    """The levels from the given one down to the smallest, each (height, width, channels) float64.

    Sizes halve, rounding down, as in OpenGL, WebGPU and OpenCL; a level of odd size is averaged over the
    exact area that each texel covers.

    level    the largest level
    weights  (height, width) weights of its texels, such as their solid angles; the plain mean if None
    least    the chain ends where the larger side is this or 1
    """
    values = np.asarray(level, np.float64)
    weight = np.ones(values.shape[:2]) if weights is None else np.asarray(weights, np.float64)
    levels = [values]
    while max(values.shape[:2]) > max(least, 1):
        values, weight = _halved(values, weight)
        levels.append(values)
    return levels


def by_solid_angle(pixels: npt.NDArray[np.floating]) -> list[Array]:
    """The chain of a latitude-longitude map: each texel the mean over the part of the sphere it covers."""
    rows = latlong.solid_angles(*pixels.shape[:2])
    return chain(pixels, np.broadcast_to(rows[:, None], pixels.shape[:2]))


def reduced(pixels: npt.NDArray[np.floating], rows: int) -> Array:
    """The largest level of that chain with at most so many rows."""
    return next(level for level in by_solid_angle(pixels) if level.shape[0] <= max(rows, 1))


def _halved(values: Array, weight: Array) -> tuple[Array, Array]:
    rows, columns = (_cover(n, max(n // 2, 1)) for n in values.shape[:2])
    smaller = np.einsum("ij,jk,lk->il", rows, weight, columns, optimize=True)
    seen = smaller > 0.0
    total = np.einsum("ij,jkc,lk->ilc", rows, values * weight[..., None], columns, optimize=True)
    weighted = np.asarray(total / np.where(seen, smaller, 1.0)[..., None])
    if seen.all():
        return weighted, smaller
    # A texel none of whose parts has weight (outside a map's disc) keeps the plain mean.
    plain = np.einsum("ij,jkc,lk->ilc", rows, values, columns, optimize=True)
    plain /= (rows.sum(axis=1)[:, None] * columns.sum(axis=1)[None, :])[..., None]
    return np.where(seen[..., None], weighted, plain), smaller


def _cover(old: int, new: int) -> Array:
    """How much of each old texel each new one covers, (new, old)."""
    edges = np.arange(new + 1) * (old / new)
    left, right = edges[:-1, None], edges[1:, None]
    texel = np.arange(old)[None, :]
    return np.asarray(np.clip(np.minimum(right, texel + 1.0) - np.maximum(left, texel), 0.0, None))
