"""Guards that ranges prove idle: what takes their place, and the proof that is logged.

Plan. One guard at a time, x in [0.5, 2] and y in a range of its own.
  gone    each kind of guard, whichever operand decides it; the log shows what was proven, of which values
  stays   where the ranges overlap, where ends may cross, where a component is not decided
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from codegen.passes.specialise import specialise
from conformance.unit.support.sources import library_of

BOTH = "x in [0.5, 2], y in [3, 4]"
TURNED = "y in [3, 4], x in [0.5, 2]"
GONE = {
    "min(x, 5.0)": ("min(x, 5) -> x", "x in [0.5, 2]"),
    "min(x, 0.25)": ("min(x, 0.25) -> 0.25", "x in [0.5, 2]"),
    "min(x, y)": ("min(x, y) -> x", BOTH),
    "max(x, y)": ("max(x, y) -> y", TURNED),
    "clamp(x, 0.5, 2.0)": ("clamp(x, 0.5, 2) -> x", "x in [0.5, 2], inside the ends"),
    "clamp(x, 2.0, 9.0)": ("clamp(x, 2, 9) -> 2", "x in [0.5, 2]"),
    "clamp(x, -9.0, 0.5)": ("clamp(x, -9, 0.5) -> 0.5", "x in [0.5, 2]"),
    "clamp(x, y, 9.0)": ("clamp(x, y, 9) -> y", BOTH),
    "clamp(y, 0.0, x)": ("clamp(y, 0, x) -> x", TURNED),
    "clamp(x, 0.0, y)": ("clamp(x, 0, y) -> x", "x in [0.5, 2], inside the ends"),
    "clamp(x, 0.0, 1.0)": ("clamp(x, 0, 1) -> min(x, 1)", "x in [0.5, 2]"),
    "clamp(x, 1.0, 9.0)": ("clamp(x, 1, 9) -> max(x, 1)", "x in [0.5, 2]"),
    "abs(x - y)": ("abs(x - y) -> y - x", ""),
    "abs(x)": ("abs(x) -> x", "x in [0.5, 2]"),
    "1.0 if x < y else x": ("x < y -> true", BOTH),
    "1.0 if y <= x else x": ("y <= x -> false", TURNED),
    "1.0 if x > 5.0 else x": ("x > 5 -> false", "x in [0.5, 2]"),
}
STAYS = ("min(x, 1.0)", "max(x, z)", "clamp(x, z, 1.0)", "abs(x - 1.0)", "1.0 if x < 2.0 else x")


def steps(folder: Path, text: str) -> list[Any]:
    library = library_of(folder, f"def probe(x: X, y: X, z: X) -> f32:\n    return {text}\n")
    ranges = {"x": (0.5, 2.0), "y": (3.0, 4.0), "z": (0.25, 3.0)}
    return [s for s in specialise(library, "probe", ranges=ranges, new_name="p").log if s.name == "ranges"]


@pytest.mark.parametrize("text", GONE)
def test_idle_guard_goes_with_its_proof(text: str, tmp_path: Path) -> None:
    what, proof = GONE[text]
    found = [(s.what, s.why) for s in steps(tmp_path, text)]
    assert len(found) == 1
    assert found[0][0] == what
    assert found[0][1].startswith("proven on every target: ")
    if proof:
        assert found[0][1] == f"proven on every target: {proof}"


@pytest.mark.parametrize("text", STAYS)
def test_guard_that_may_act_stays(text: str, tmp_path: Path) -> None:
    assert steps(tmp_path, text) == []


def test_vector_guard_needs_every_component(tmp_path: Path) -> None:
    ranges = {"x": (0.5, 2.0), "y": (3.0, 4.0)}
    for k, (text, gone) in enumerate(
        {"max(vec2(y, x), vec2(1.0))": 0, "max(vec2(y, y), vec2(1.0))": 1}.items()
    ):
        library = library_of(tmp_path / str(k), f"def probe(x: X, y: X) -> vec2:\n    return {text}\n")
        log = specialise(library, "probe", ranges=ranges, new_name="p").log
        assert len([s for s in log if s.name == "ranges"]) == gone
