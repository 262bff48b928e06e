"""Lookups in maps, over boxes of places and of levels, have the very ends that one finds place by place.

Plan. Maps of several levels at random, longer one way than the other, repeated or clamped along either axis.
Each lane is a box of places and levels. Expected are the least and the largest value at the corners and at
the centres of texels of the box, widened by what the table says of weights and by the 64 roundings of float32
that are granted to coordinates and sums; levels inside the box of levels count whole. Each result is the
float at or beyond that end, and no other.
  known       boxes of one place
  boxes       few centres, as many as are looked at one by one, and more; beyond the map on either side
  levels      none asked for, one, between two, over several, below the first and beyond the last
  causes      of either coordinate and of the level; the first of them
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from codegen.evaluate.textures import TextureMap
from codegen.intervals import load_table
from codegen.intervals.accuracy import Filter
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.lookups import lookup
from codegen.intervals.tables import Table
from codegen.intervals.values import Range
from conformance.unit.support.tolerances import tolerance

SEED = 20_265
GRANTED = 2.0**-18
"""64 roundings of float32."""
ONE_BY_ONE = 3
"""Centres of a box along an axis that are looked at one by one; of more, all texels count."""
SIZES = ((4, 8), (2, 4), (1, 2), (1, 1))
"""Height and width of the levels."""

Box = tuple[float, float]


def rows(name: str) -> tuple[Table, Filter, Filter]:
    """The table, with weights of its own for lookups in levels, and both rows."""
    table = load_table(name)
    plain = table.row("lookup").accuracy
    assert isinstance(plain, Filter)
    other = Filter(plain.texel / 2.0, plain.level / 4.0)
    level = replace(table.row("lookup_level"), accuracy=other)
    return replace(table, rows={**table.rows, "lookup_level": level}), plain, other


def texels(levels: int) -> list[Any]:
    rng = np.random.default_rng(SEED)
    return [rng.uniform(-2.0, 1.0, (*size, 4)).astype(np.float32) for size in SIZES[:levels]]


def value(level: Any, x: float, y: float, repeats: tuple[bool, bool]) -> Any:
    """Bilinear between centres, 0 being the first."""
    height, width, _ = level.shape
    total = np.zeros(4)
    for dx, dy in itertools.product((0, 1), (0, 1)):
        i, j = math.floor(x) + dx, math.floor(y) + dy
        weight = (1.0 - abs(x - i)) * (1.0 - abs(y - j))
        i = i % width if repeats[0] else min(max(i, 0), width - 1)
        j = j % height if repeats[1] else min(max(j, 0), height - 1)
        total = total + weight * level[j, i].astype(np.float64)
    return total


def places(box: Box, size: int, texel: float, repeats: bool) -> list[float] | None:
    """Coordinates in texels where extremes may lie; None where any texel may be one."""
    low, high = (end * size if repeats else min(max(end * size, 0.0), size) for end in box)
    off = texel + GRANTED * (max(abs(low), abs(high)) + 1.0)
    low, high = low - 0.5 - off, high - 0.5 + off
    centres = [float(n) for n in range(math.ceil(low), math.floor(high) + 1)]
    return None if len(centres) > ONE_BY_ONE else [low, *centres, high]


def over_box(level: Any, u: Box, v: Box, texel: float, repeats: tuple[bool, bool]) -> tuple[Any, Any]:
    xs = places(u, level.shape[1], texel, repeats[0])
    ys = places(v, level.shape[0], texel, repeats[1])
    if xs is None or ys is None:
        every = level.reshape(-1, 4).astype(np.float64)
    else:
        every = np.array([value(level, x, y, repeats) for x in xs for y in ys])
    return every.min(axis=0), every.max(axis=0)


def expected(
    levels: list[Any], u: Box, v: Box, lod: Box | None, accuracy: Filter, repeats: tuple[bool, bool]
) -> tuple[Any, Any]:
    last = len(levels) - 1
    boxes = [over_box(level, u, v, accuracy.texel, repeats) for level in levels]
    wide = (0.0, 0.0) if lod is None else (lod[0] - accuracy.level, lod[1] + accuracy.level)
    first, end = (min(max(k, 0.0), float(last)) for k in wide)
    found = []
    for k in (first, end, *(float(k) for k in range(last + 1) if first < k < end)):
        below, above = math.floor(k), min(math.floor(k) + 1, last)
        share = k - below
        found.append([boxes[below][e] * (1.0 - share) + boxes[above][e] * share for e in (0, 1)])
    low, high = np.min([f[0] for f in found], axis=0), np.max([f[1] for f in found], axis=0)
    slack = GRANTED * np.maximum(np.abs(low), np.abs(high))
    return low - slack, high + slack


def assert_ends(found: tuple[Range, ...], lane: int, low: Any, high: Any) -> None:
    """Each end is the float at or beyond the expected one."""
    near = tolerance("texels_by_hand")
    for k, component in enumerate(found):
        for end, exact, side in ((component.low[lane], low[k], -1.0), (component.high[lane], high[k], 1.0)):
            beyond = side * (end - exact)
            step = float(np.spacing(np.float32(abs(exact))))
            assert -near <= beyond <= step + near, (k, end, exact)
            assert end == float(np.float32(end))


def ranges(boxes: list[Box]) -> Range:
    low, high = (np.array([box[k] for box in boxes]) for k in (0, 1))
    return Range(low, high)


AXIS = [(0.5, 0.5), (0.03, 0.03), (0.97, 0.99), (0.2, 0.45), (0.1, 0.9), (-0.3, -0.1), (1.2, 1.3), (0.0, 1.0)]
NARROW = [(0.31, 0.32), (0.0, 0.0), (1.0, 1.0), (0.4, 0.65), (-2.1, -2.0), (7.9, 8.0)]
PLACES = [
    *itertools.product(AXIS, AXIS[:4]),
    *itertools.product(AXIS[:4], AXIS[4:]),
    *zip(NARROW, NARROW[::-1], strict=True),
]
LODS: list[Box] = [
    (0.0, 0.0),
    (0.4, 0.4),
    (1.0, 1.0),
    (0.2, 2.7),
    (-3.0, -1.0),
    (9.0, 9.5),
    (2.95, 2.95),
    (1.1, 1.9),
]


@pytest.mark.parametrize("repeats", [(False, False), (False, True), (True, False), (True, True)])
@pytest.mark.parametrize("name", ["wgsl", "vulkan"])
def test_ends_of_a_lookup(name: str, repeats: tuple[bool, bool]) -> None:
    table, accuracy, _ = rows(name)
    levels = texels(2)
    u, v = (ranges([place[k] for place in PLACES]) for k in (0, 1))
    context = Context(table, CauseBook(), len(PLACES))
    found = lookup(context, TextureMap(tuple(levels), *repeats), u, v, None)
    for lane, (box_u, box_v) in enumerate(PLACES):
        assert_ends(found, lane, *expected(levels, box_u, box_v, None, accuracy, repeats))
    assert all(component.cause is None for component in found)


@pytest.mark.parametrize("count", [1, 2, 4])
@pytest.mark.parametrize("name", ["wgsl", "vulkan"])
def test_ends_of_a_lookup_between_levels(name: str, count: int) -> None:
    table, _, accuracy = rows(name)
    levels, repeats = texels(count), (True, False)
    lanes = [(place, lod) for k, place in enumerate(PLACES[::7]) for lod in LODS[k % 2 :: 2]]
    u, v = (ranges([place[k] for place, _ in lanes]) for k in (0, 1))
    context = Context(table, CauseBook(), len(lanes))
    found = lookup(context, TextureMap(tuple(levels), *repeats), u, v, ranges([lod for _, lod in lanes]))
    for lane, ((box_u, box_v), lod) in enumerate(lanes):
        assert_ends(found, lane, *expected(levels, box_u, box_v, lod, accuracy, repeats))


def test_coordinates_and_levels_that_all_lanes_share() -> None:
    levels, lanes, name = texels(3), 3, "vulkan"
    accuracy = load_table(name).row("lookup_level").accuracy
    assert isinstance(accuracy, Filter)
    boxes = [(0.1, 0.2), (0.4, 0.45), (0.8, 0.81)]
    one, many = (0.3, 0.35), ranges(boxes)
    for u, v, lod in itertools.product((False, True), repeat=3):
        given = [many if whole else ranges([one]) for whole in (u, v, lod)]
        found = lookup(Context(load_table(name), CauseBook(), lanes), TextureMap(tuple(levels)), *given)
        for lane in range(lanes):
            x, y, k = (boxes[lane] if whole else one for whole in (u, v, lod))
            assert_ends(found, lane, *expected(levels, x, y, k, accuracy, (False, False)))


def test_the_first_cause_is_that_of_the_lookup() -> None:
    """Of u before v before the level; a bounded lane beside them keeps its ends."""
    table, level = load_table("vulkan"), texels(2)
    accuracy = table.row("lookup_level").accuracy
    assert isinstance(accuracy, Filter)
    for mask in itertools.product((False, True), repeat=3):
        codes = [
            np.array([0, code], np.int16) if on else None for code, on in zip((1, 7, 9), mask, strict=True)
        ]
        sides = [
            Range(
                np.array([0.4, 0.4 if c is None else -np.inf]),
                np.array([0.4, 0.4 if c is None else np.inf]),
                c,
            )
            for c in codes
        ]
        with np.errstate(invalid="ignore"):
            found = lookup(Context(table, CauseBook(), 2), TextureMap(tuple(level)), *sides)
        box = (0.4, 0.4)
        assert_ends(found, 0, *expected(level, box, box, box, accuracy, (False, False)))
        for component in found:
            if not any(mask):
                assert component.cause is None
                continue
            assert component.cause is not None
            assert component.cause.tolist() == [0, (1, 7, 9)[mask.index(True)]]
            assert (component.low[1], component.high[1]) == (-np.inf, np.inf)
