"""A memory of evaluated expressions changes no value: with one and without, bits agree.

Plan. Functions with calls, structs and branches are evaluated with one memory, twice, and then with every
variant at every call site; a scene with loops over arrays likewise. Each result is held against evaluation
without a memory. What is remembered is not evaluated again.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Value
from codegen.evaluate.memory import Key, Memory
from codegen.library import Library, load_library
from codegen.scene.description.document import read_scene
from codegen.scene.general import general_function
from codegen.scene.proof.points import draw as scene_points
from codegen.scene.reduction.sites import sites, substituted
from conformance.cases.drawing import draw, families_for
from conformance.unit.support.sources import library_of

LIBRARY = load_library()
NAMES = ("fakefur_shade", "brushed_shade", "safe_normalize", "fur_geometry")
COUNT = 64
LOOPS = '[shade]\nmodel = "fakefur"\n[lights]\ndirectional = 5\npoint = 6\n'


def bits(value: Any) -> list[bytes]:
    if isinstance(value, dict):
        return [b for part in value.values() for b in bits(part)]
    return [np.ascontiguousarray(value).tobytes()]


class Counting(Memory):
    """Counts what is evaluated."""

    evaluated = 0

    def keep(self, key: Key, made: Value, of: list[Value]) -> Value:
        self.evaluated += 1
        return super().keep(key, made, of)


def check(library: Library, name: str, inputs: Any, memory: Memory) -> None:
    plain = evaluate(library, name, inputs)
    assert bits(evaluate(library, name, inputs, memory=memory)) == bits(plain)


@pytest.mark.parametrize("name", NAMES)
def test_a_memory_changes_no_value(name: str) -> None:
    function = LIBRARY.function(name)
    inputs = draw(function, families_for(function.parameters)[0], COUNT)
    memory = Memory()
    for _ in range(2):
        check(LIBRARY, name, inputs, memory)
    for site in sites(LIBRARY, function, {}, {}):
        for option in site.options:
            made = substituted(LIBRARY, function, {site.path: option}, "changed")
            check(LIBRARY.with_functions(made), "changed", inputs, memory)


def test_loops_are_remembered_light_by_light(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(LOOPS, encoding="utf-8")
    scene = read_scene(tmp_path / "scene.toml", LIBRARY)
    general = general_function(scene)
    library = LIBRARY.with_functions([general.function])
    memory, inputs = Counting(), scene_points(scene, general, COUNT).inputs
    check(library, general.function.name, inputs, memory)
    once = memory.evaluated
    check(library, general.function.name, inputs, memory)
    assert memory.evaluated == once + 1  # what comes after the loops


TWO = """def first(x: X, y: X) -> f32:
    a = x * y
    b = sqrt(abs(a))
    return b + x
def second(x: X, y: X) -> f32:
    a = x * y
    b = sqrt(abs(a))
    return b - x
"""


def test_what_is_remembered_is_not_evaluated_again(tmp_path: Path) -> None:
    """Of the second function only what the first one has not: its last line."""
    library, memory = library_of(tmp_path, TWO), Counting()
    inputs = {name: np.full(COUNT, 0.75, np.float32) for name in "xy"}
    counts = []
    for name in ("first", "first", "second"):
        before = memory.evaluated
        evaluate(library, name, inputs, memory=memory)
        counts.append(memory.evaluated - before)
    assert counts == [3, 0, 1]


CALLS = """@helper
def squared(y: X) -> f32:
    return y * y
def probe(x: X, y: X) -> f32:
    z = y
    a = squared(z)
    return x * a + squared(y)
"""


def test_calls_are_remembered_by_their_arguments(tmp_path: Path) -> None:
    """The square, the call and the sum once; then, with another x, the sum alone."""
    library, memory = library_of(tmp_path, CALLS), Counting()
    y = np.array([0.5, 3.0], np.float32)
    counts = []
    for x in (np.array([2.0, 4.0], np.float32), np.array([-1.0, 0.25], np.float32)):
        before = memory.evaluated
        found: Any = evaluate(library, "probe", {"x": x, "y": y}, memory=memory)
        counts.append(memory.evaluated - before)
        assert np.array_equal(found, x * y**2 + y**2)
    assert counts == [3, 1]


def test_other_inputs_under_the_same_names_are_other_values() -> None:
    memory = Memory()
    for x in (0.25, 0.5):
        check(LIBRARY, "safe_sqrt", {"x": np.full(COUNT, x, np.float32)}, memory)
