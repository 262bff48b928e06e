"""Maps with their levels as values, and what a lookup in them means.

Texel (i, j) of a level of w by h lies at ((i + 1/2) / w, (j + 1/2) / h). A lookup weighs the four texels
about (u, v) bilinearly, and two levels linearly. Beyond the edges a map repeats or its edge goes on, as the
domain of the parameter says. Levels below 0 count as 0, levels beyond the last as the last.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.ir.domains import Domain, Edges

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class TextureMap:
    """A chain of levels, float32 (h, w, 4), the largest first; how it goes on beyond its edges."""

    levels: tuple[npt.NDArray[np.float32], ...]
    repeat_u: bool = False
    repeat_v: bool = False

    def with_edges(self, domain: Domain | None) -> TextureMap:
        """The map as a parameter with that domain sees it."""
        assert isinstance(domain, Edges)
        return replace(self, repeat_u=domain.u == "repeat", repeat_v=domain.v == "repeat")


def as_map(value: object) -> TextureMap | None:
    """A value of the interpreters, if it is a map: maps travel among arrays, only lookups look at them."""
    return value if isinstance(value, TextureMap) else None


def texture_map(where: str, given: Any) -> TextureMap:
    """A map from an array (h, w, 4) or a sequence of them; raises UserError if they are no such chain."""
    if isinstance(given, TextureMap):
        return given
    arrays = [given] if isinstance(given, np.ndarray) else given
    if not isinstance(arrays, Sequence) or not arrays:
        raise UserError(f"{where} is a map: give an array (h, w, 4), or a list of them, the largest first")
    levels = [np.ascontiguousarray(a, np.float32) for a in arrays]
    for k, a in enumerate(levels):
        if a.ndim != 3 or a.shape[2] != 4 or not a.size:
            raise UserError(f"{where}: level {k} has shape {a.shape}, but (h, w, 4) is needed")
        if not np.isfinite(a).all():
            raise UserError(
                f"{where}: level {k} holds {int((~np.isfinite(a)).sum())} numbers that are not finite"
            )
        wanted = tuple(max(n >> k, 1) for n in levels[0].shape[:2])
        if a.shape[:2] != wanted:
            raise UserError(
                f"{where}: level {k} has shape {a.shape}, but {(*wanted, 4)} follows from level 0"
            )
    if len(levels) > max(levels[0].shape[:2]).bit_length():
        raise UserError(
            f"{where} has {len(levels)} levels; {levels[0].shape} has no more than its size allows"
        )
    return TextureMap(tuple(levels))


def lookup_in(
    floats: type[np.generic], floor: Callable[[Array], Array], number: Callable[[float], Any] | None = None
) -> Callable[..., Array]:
    """The meaning of lookup_level in an arithmetic: (map, uv, level or None for 0) -> (N, 4).

    number  makes one number of the arithmetic; that of numpy's type if None
    """
    make: Callable[[float], Any] = number or floats

    def lookup_level(t: TextureMap, uv: Array, level: Array | None) -> Array:
        count = len(uv)
        last = len(t.levels) - 1
        held = np.zeros(count, floats) if level is None else np.minimum(np.maximum(level, 0), last)
        first = _whole(floor(held), 0, last)
        share = (held - first.astype(floats))[:, None]
        second = np.minimum(first + 1, last)
        result = np.zeros((count, 4), floats)
        for k in range(last + 1):
            for chosen, weight in ((first == k, 1 - share), (second == k, share)):
                lanes = np.flatnonzero(chosen)
                if len(lanes):
                    result[lanes] = result[lanes] + weight[lanes] * bilinear(t, k, uv[lanes])
        return result

    def bilinear(t: TextureMap, k: int, uv: Array) -> Array:
        texels = t.levels[k].astype(floats)
        height, width = texels.shape[:2]
        i0, i1, x = neighbours(uv[:, 0], width, t.repeat_u)
        j0, j1, y = neighbours(uv[:, 1], height, t.repeat_v)
        top = texels[j0, i0] * (1 - x) + texels[j0, i1] * x
        bottom = texels[j1, i0] * (1 - x) + texels[j1, i1] * x
        return np.asarray(top * (1 - y) + bottom * y)

    def neighbours(s: Array, size: int, repeats: bool) -> tuple[Array, Array, Array]:
        """Both texels about a coordinate, and the weight of the second one as a column."""
        inside = s - floor(s) if repeats else np.minimum(np.maximum(s, 0), 1)
        at = inside * make(size) - make(0.5)
        below = floor(at)
        index = _whole(below, -1, size)
        if repeats:
            return index % size, (index + 1) % size, (at - below)[:, None]
        return np.clip(index, 0, size - 1), np.clip(index + 1, 0, size - 1), (at - below)[:, None]

    return lookup_level


def size_in(
    floats: type[np.generic], number: Callable[[float], Any] | None = None
) -> Callable[[TextureMap], Array]:
    """The meaning of texture_size in an arithmetic: width and height of the largest level, (1, 2)."""
    make: Callable[[float], Any] = number or floats

    def texture_size(t: TextureMap) -> Array:
        height, width = t.levels[0].shape[:2]
        return np.array([[make(width), make(height)]], floats)

    return texture_size


def _whole(a: Array, low: int, high: int) -> Array:
    """Whole numbers as integers; lanes that no branch takes may hold anything."""
    numbers = np.nan_to_num(a.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    return np.clip(numbers, low, high).astype(np.int64)
