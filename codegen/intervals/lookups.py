"""Lookups in maps: every value that filter weights of a stated precision can give.

Between the centres of its texels a level is bilinear, and between levels a map is linear. A weight that is
off by e gives the value at a place that is off by e texels (or levels). So what is permitted lies between the
least and the largest value over a box: the intervals of u, v and level, widened by e. A multilinear function
takes these at corners: the ends of the box, and the centres inside it.
"""

from __future__ import annotations

import itertools

import numpy as np

from codegen.evaluate.textures import TextureMap
from codegen.intervals.accuracy import Filter
from codegen.intervals.causes import Codes, first
from codegen.intervals.context import Context
from codegen.intervals.numbers import Array, down, up
from codegen.intervals.values import Range

ARITHMETIC = 2.0**-18
"""Relative error granted to coordinates in texels and to sums of weighted texels: 64 roundings of float32."""
CENTRES = 3
"""A box that holds more centres along an axis is bounded by all texels of the level."""


def lookup(context: Context, t: TextureMap, u: Range, v: Range, lod: Range | None) -> tuple[Range, ...]:
    """The four components of a lookup; lod None: in the largest level."""
    row = context.table.row("lookup" if lod is None else "lookup_level").accuracy
    assert isinstance(row, Filter)
    lanes, last = context.lanes, len(t.levels) - 1
    cause: Codes = first(u.cause, v.cause, None if lod is None else lod.cause)
    k_low = k_high = np.zeros(lanes)
    if lod is not None:
        k_low = np.clip(np.broadcast_to(lod.low, lanes) - row.level, 0.0, last)
        k_high = np.clip(np.broadcast_to(lod.high, lanes) + row.level, 0.0, last)
    # Along the level the ends of the box are values between two levels; levels inside it count whole.
    low, high = np.full((lanes, 4), np.inf), np.full((lanes, 4), -np.inf)
    ranges = [_level(t, k, u, v, lanes, row.texel) for k in range(last + 1)]
    for end in (k_low, k_high):
        below = np.clip(np.floor(np.nan_to_num(end)), 0, last).astype(int)
        above = np.minimum(below + 1, last)
        share = (end - below)[:, None]
        least, most = (
            _picked(side, below) * (1.0 - share) + _picked(side, above) * share
            for side in ([r[0] for r in ranges], [r[1] for r in ranges])
        )
        low, high = np.minimum(low, least), np.maximum(high, most)
    for k, (least, most) in enumerate(ranges):
        inside = (k_low < k) & (k < k_high)
        low[inside] = np.minimum(low[inside], least[inside])
        high[inside] = np.maximum(high[inside], most[inside])
    slack = ARITHMETIC * np.maximum(np.abs(low), np.abs(high))
    unknown = np.zeros(lanes, np.bool_) if cause is None else np.broadcast_to(cause, lanes) > 0
    low = np.where(unknown[:, None], -np.inf, low - slack)
    high = np.where(unknown[:, None], np.inf, high + slack)
    columns = [(np.ascontiguousarray(low[:, c]), np.ascontiguousarray(high[:, c])) for c in range(4)]
    return tuple(Range(down(a), up(b), cause) for a, b in columns)


def _picked(levels: list[Array], which: Array) -> Array:
    """Lane by lane the row of one of the levels."""
    return np.stack(levels)[which, np.arange(len(which))]


def _level(t: TextureMap, k: int, u: Range, v: Range, lanes: int, texel: float) -> tuple[Array, Array]:
    """Least and largest value of one level over the box, (N, 4) each."""
    texels = t.levels[k].astype(np.float64)
    height, width = texels.shape[:2]
    xs, many_x = _places(u, width, lanes, texel, t.repeat_u)
    ys, many_y = _places(v, height, lanes, texel, t.repeat_v)
    low, high = np.full((lanes, 4), np.inf), np.full((lanes, 4), -np.inf)
    for x, y in itertools.product(xs, ys):
        value = _bilinear(texels, x, y, t.repeat_u, t.repeat_v)
        low, high = np.minimum(low, value), np.maximum(high, value)
    everywhere = (many_x | many_y)[:, None]
    whole = texels.reshape(-1, 4)
    return np.where(everywhere, whole.min(axis=0), low), np.where(everywhere, whole.max(axis=0), high)


def _places(s: Range, size: int, lanes: int, texel: float, repeats: bool) -> tuple[list[Array], Array]:
    """Coordinates in texels where extremes may lie, 0 at the first centre; and where there are too many."""
    low, high = (np.broadcast_to(end, lanes) * size for end in (s.low, s.high))
    if not repeats:
        low, high = np.clip(low, 0.0, size), np.clip(high, 0.0, size)
    slack = texel + ARITHMETIC * (np.maximum(np.abs(low), np.abs(high)) + 1.0)
    low, high = low - 0.5 - slack, high - 0.5 + slack
    many = ~(np.floor(high) - np.ceil(low) < CENTRES)
    low, high = (np.where(many, 0.0, end) for end in (low, high))
    centres = [np.clip(np.ceil(low) + k, low, high) for k in range(CENTRES)]
    return [low, high, *centres], many


def _bilinear(texels: Array, x: Array, y: Array, repeat_u: bool, repeat_v: bool) -> Array:
    height, width = texels.shape[:2]
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - i)[:, None], (y - j)[:, None]

    def index(n: Array, size: int, repeats: bool) -> Array:
        return n % size if repeats else np.clip(n, 0, size - 1)

    i0, i1 = index(i, width, repeat_u), index(i + 1, width, repeat_u)
    j0, j1 = index(j, height, repeat_v), index(j + 1, height, repeat_v)
    top = texels[j0, i0] * (1.0 - fx) + texels[j0, i1] * fx
    bottom = texels[j1, i0] * (1.0 - fx) + texels[j1, i1] * fx
    return np.asarray(top * (1.0 - fy) + bottom * fy)
