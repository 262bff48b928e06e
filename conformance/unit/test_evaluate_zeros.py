"""The evaluator knows a constant 0.0 from -0.0, whatever was evaluated before.

Plan. Functions that differ in the sign of a zero alone, which shows in the side of an angle, are evaluated
one after the other: by themselves, over one memory, and in loops that are evaluated all iterations at once.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.evaluate.memory import Memory
from conformance.unit.support.sources import library_of

PROBES = """def above(x: X) -> f32:
    return atan2(0.0, x)
def below(x: X) -> f32:
    return atan2(-0.0, x)
def summed_above(x: X) -> f32:
    total = 0.5
    for i in range(2, 5):
        total = total + atan2(0.0, x * f32(i))
    return total - 0.5
def summed_below(x: X) -> f32:
    total = 0.5
    for i in range(2, 5):
        total = total + atan2(-0.0, x * f32(i))
    return total - 0.5
"""


@pytest.mark.parametrize("memory", [False, True])
@pytest.mark.parametrize("first", ["above", "below"])
@pytest.mark.parametrize("form", ["", "summed_"])
@pytest.mark.parametrize("arithmetic", ["float32", "float64"])
def test_signs_of_zero_are_two(arithmetic: str, form: str, first: str, memory: bool, tmp_path: Path) -> None:
    library, x = library_of(tmp_path, PROBES), np.array([-1.0, -2.0])
    kept = Memory() if memory else None
    for side in (first, "below" if first == "above" else "above"):
        found: Any = evaluate(library, form + side, {"x": x}, arithmetic, memory=kept)
        assert np.array_equal(np.sign(found), [1.0, 1.0] if side == "above" else [-1.0, -1.0]), side
