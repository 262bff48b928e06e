"""What lookups in maps may give: by the precision of weights alone, over boxes of places and between levels.

Plan. Maps by hand or at random.
  levels    level k holds the number k, so that a lookup between levels gives the level, off by its weight
  anywhere  a box over all texels holds all of them, and no more
  cause     a place that may be anything makes its own lane so, and no other
  places    every lookup inside a box lies in the interval of the box
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.evaluate.textures import TextureMap
from codegen.intervals import TABLES, load_table, permitted
from codegen.intervals.accuracy import Filter
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.lookups import ARITHMETIC, lookup
from codegen.intervals.values import Range
from conformance.unit.support.sources import library_of

SEED = 20_261
ROUNDED = 2.0 * ARITHMETIC
"""How much wider rounding of products and of their sum makes either end of a lookup of values up to 1."""


def context(lanes: int, table: str = "wgsl") -> Context:
    return Context(load_table(table), CauseBook(), lanes)


@pytest.mark.parametrize("name", TABLES)
def test_lookup_between_levels_is_off_by_the_weight_of_levels_alone(name: str) -> None:
    accuracy = load_table(name).row("lookup_level").accuracy
    assert isinstance(accuracy, Filter)
    levels = tuple(np.full((size, size, 4), k, np.float32) for k, size in enumerate((8, 4, 2, 1)))
    lod = np.array([0.0, 0.25, 1.0, 1.5, 2.75, 3.0])
    half = np.full(lod.shape, 0.5)
    here = Range(half, half)
    found = lookup(context(len(lod), name), TextureMap(levels), here, here, Range(lod, lod))
    slack = ROUNDED * len(levels)
    for component in found:
        for end, wanted in ((component.low, lod - accuracy.level), (component.high, lod + accuracy.level)):
            np.testing.assert_allclose(end, np.clip(wanted, 0.0, 3.0), rtol=0.0, atol=slack)
        assert (component.low <= lod).all() and (component.high >= lod).all()


def test_function_looks_up_in_the_level_that_it_asks_for(tmp_path: Path) -> None:
    """And in the largest one where it asks for none."""
    text = (
        'def probe(t: Annotated[Texture, Edges("repeat", "clamp")], uv: P, lod: X) -> vec2:\n'
        "    return vec2(lookup_level(t, uv, lod).x, lookup(t, uv).x)\n"
    )
    levels = [np.full((size, size, 4), k + 1, np.float32) for k, size in enumerate((4, 2, 1))]
    lod = np.array([0.0, 1.0, 2.0], np.float32)
    inputs = {"t": levels, "uv": np.full((3, 2), 0.5, np.float32), "lod": lod}
    found: Any = permitted(library_of(tmp_path, text), "probe", inputs, "wgsl")
    for column, expected in ((0, lod + 1.0), (1, np.ones(3))):
        assert (found.low[:, column] <= expected).all() and (expected <= found.high[:, column]).all()
    assert (found.high[:, 1] < 1.5).all(), "the largest level is 1 everywhere"


@pytest.mark.parametrize("along", [0, 1])
def test_lookup_anywhere_gives_any_texel_and_no_more(along: int) -> None:
    texels = np.random.default_rng(SEED).uniform(-1.0, 1.0, (8, 8, 4)).astype(np.float32)
    anywhere, here = Range(np.zeros(1), np.ones(1)), Range(np.full(1, 0.5), np.full(1, 0.5))
    u, v = (anywhere, here) if along == 0 else (here, anywhere)
    found = lookup(context(1), TextureMap((texels,)), u, v, None)
    for component, of in zip(found, texels.reshape(-1, 4).T, strict=True):
        near = float(of.min()), float(of.max())
        assert (component.low[0], component.high[0]) == pytest.approx(near, abs=ROUNDED)
        assert component.low[0] <= near[0] and component.high[0] >= near[1]


def test_lookup_at_a_place_that_may_be_anything_is_anything() -> None:
    texels = np.random.default_rng(SEED).uniform(-1.0, 1.0, (4, 4, 4)).astype(np.float32)
    half = np.full(2, 0.5)
    u = Range(np.array([-np.inf, 0.5]), np.array([np.inf, 0.5]), np.array([1, 0], np.int16))
    with np.errstate(all="ignore"):
        found = lookup(context(2), TextureMap((texels,)), u, Range(half, half), None)
    for component in found:
        assert component.cause is not None and component.cause.tolist() == [1, 0]
        assert np.isinf(component.low).tolist() == np.isinf(component.high).tolist() == [True, False]


MAP = """def probe(t: Annotated[Texture, Edges("clamp", "clamp")], at: P) -> vec4:
    return lookup(t, at)
"""


def test_boxes_of_places_hold_every_lookup_in_them(tmp_path: Path) -> None:
    random, lanes = np.random.default_rng(SEED), 80
    texels = random.uniform(-1.0, 1.0, (4, 8, 4)).astype(np.float32)
    low = random.uniform(0.0, 1.0, (lanes, 2)).astype(np.float32)
    high = np.minimum(low + random.choice([0.0, 0.1, 0.4], (lanes, 2)).astype(np.float32), np.float32(1.0))
    u, v = (Range(low[:, k].astype(np.float64), high[:, k].astype(np.float64)) for k in range(2))
    found = lookup(context(lanes), TextureMap((texels,)), u, v, None)
    library = library_of(tmp_path, MAP)
    for _ in range(20):
        at = low + random.uniform(0.0, 1.0, (lanes, 2)).astype(np.float32) * (high - low)
        values = evaluate(library, "probe", {"t": texels, "at": at})
        assert isinstance(values, np.ndarray)
        for component, x in zip(found, values.T, strict=True):
            assert (component.low <= x).all() and (x <= component.high).all()
