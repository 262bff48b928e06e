"""Lanes evaluated block by block, and arrays moved into large pages, are the same to the bit.

Plan.
  blocks  functions with structs, branches, loops, a loop that a parameter ends: blocks that divide the lanes
          and blocks that do not, in both precisions; one value for all lanes
  pages   arrays in either order keep their values and the order; parts of others and small ones stay
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from codegen.evaluate import blocks, evaluate
from codegen.evaluate.pages import CHUNK, LEAST, Pages
from codegen.library import load_library
from conformance.cases.drawing import draw, families_for
from conformance.unit.support.sources import library_of

LIBRARY = load_library()
NAMES = ("fakefur_shade", "brushed_shade", "safe_normalize", "ward_pdf")
COUNT = 64
ENDS_EARLY = """def probe(x: X, most: Annotated[i32, Interval(0, 9)]) -> f32:
    total = 0.0
    for i in range(min(most, 9)):
        total = total * x + f32(i)
    return total
"""


@pytest.mark.parametrize("arithmetic", ["float32", "float64"])
@pytest.mark.parametrize("size", [16, 23])
@pytest.mark.parametrize("name", NAMES)
def test_blocks_change_no_value(
    monkeypatch: pytest.MonkeyPatch, name: str, size: int, arithmetic: str
) -> None:
    function = LIBRARY.function(name)
    inputs = draw(function, families_for(function.parameters)[0], COUNT)
    whole = np.asarray(evaluate(LIBRARY, name, inputs, arithmetic))
    monkeypatch.setattr(blocks, "BLOCK", size)
    assert np.array_equal(np.asarray(evaluate(LIBRARY, name, inputs, arithmetic)), whole, equal_nan=True)


def test_each_block_runs_as_long_as_its_own_lanes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    library = library_of(tmp_path, ENDS_EARLY)
    inputs = {"x": np.float32(0.5), "most": np.arange(COUNT, dtype=np.int32) % 10}
    whole = np.asarray(evaluate(library, "probe", inputs))
    monkeypatch.setattr(blocks, "BLOCK", 3)
    assert np.array_equal(np.asarray(evaluate(library, "probe", inputs)), whole)


@pytest.mark.parametrize("order", ["C", "F"])
def test_moved_arrays_keep_values_and_order(order: str) -> None:
    pages, rows = Pages(), LEAST // 8
    arrays = [np.full((rows, 3), k, np.float64, order=order) for k in range(3 * CHUNK // (24 * rows))]  # type: ignore[call-overload]
    moved = [pages.moved(a) for a in arrays]
    for a, b in zip(arrays, moved, strict=True):
        assert np.array_equal(a, b)
        assert a.strides == b.strides


def test_parts_and_small_arrays_stay() -> None:
    large = np.zeros((LEAST, 3))
    for a in (large[: LEAST // 2], large[:, 1], np.broadcast_to(np.zeros(3), (LEAST, 3)), np.zeros(3)):
        assert Pages().moved(a) is a
