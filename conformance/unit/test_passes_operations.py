"""Operations of a function, counted: each class, per component, loops and branches as often as they run.

Plan. Functions of one or two operations whose count is known by looking at them, branches, loops; calls with
and without a library.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.library import Library
from codegen.passes.analysis.operations import CLASSES, WEIGHTS, operations, operations_by_cost
from conformance.unit.support.sources import library_of

COUNTS = {
    "x + y": {"arithmetic": 1},
    "x * y - x": {"arithmetic": 2},
    "x / y": {"special": 1},
    "sqrt(x) + exp(y)": {"arithmetic": 1, "special": 2},
    "clamp(x, 0.0, y)": {"arithmetic": 2},
    "min(x, y)": {"arithmetic": 1},
    "x if x < y else y": {"select": 1, "compare": 1},
    "dot(v, v)": {"arithmetic": 5},
    "(v * x).x": {"arithmetic": 3},
    "(v if x > y else v * y).x": {"arithmetic": 3, "select": 3, "compare": 1},
    "clamp(v, vec3(0.0), vec3(1.0)).y": {"arithmetic": 6},
    "-x": {},
}
LOOP = """    total = x
    for k in range({}):
        total = total * y + x
    return total
"""
LOOPS = {"5": 5, "2, 5": 3, "3, 4": 1, "0, 1": 1}
BRANCH = """    found = x
    if x > y:
        found = x * y
    else:
        found = x / y + 1.0
    return found
"""


def library(folder: Path, body: str, before: str = "") -> Library:
    return library_of(folder, f"{before}def probe(x: X, y: X, v: V) -> f32:\n{body}")


def test_every_class_has_its_weight() -> None:
    assert set(WEIGHTS) == set(CLASSES)


def full(counts: dict[str, int]) -> dict[str, int]:
    return {**dict.fromkeys(CLASSES, 0), **counts}


@pytest.mark.parametrize("text", COUNTS)
def test_one_expression(text: str, tmp_path: Path) -> None:
    made = library(tmp_path, f"    return {text}\n")
    assert operations(made.function("probe")) == full(COUNTS[text])


@pytest.mark.parametrize("ends", LOOPS)
def test_loop_counts_once_an_iteration(ends: str, tmp_path: Path) -> None:
    made = library(tmp_path, LOOP.format(ends))
    assert operations(made.function("probe")) == full({"arithmetic": 2 * LOOPS[ends]})
    assert operations_by_cost(made.function("probe"), made) == {"add": LOOPS[ends], "multiply": LOOPS[ends]}


def test_both_sides_of_a_branch_count(tmp_path: Path) -> None:
    made = library(tmp_path, BRANCH)
    assert operations(made.function("probe")) == full({"arithmetic": 2, "special": 1, "compare": 1})
    assert operations_by_cost(made.function("probe"), made) == {"add": 2, "divide": 1, "multiply": 1}


def test_calls_count_where_they_are_looked_up(tmp_path: Path) -> None:
    helper = "@helper\ndef part(x: X) -> f32:\n    return x * x + 1.0\n"
    made = library(tmp_path, "    return part(x) + part(y)\n", helper)
    function = made.function("probe")
    assert operations(function) == full({"arithmetic": 1})
    assert operations(function, made) == full({"arithmetic": 5})
    assert operations_by_cost(function, made) == {"add": 3, "multiply": 2}
