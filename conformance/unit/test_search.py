"""The search finds planted errors, stays inside the domains, repeats with its seed, and keeps the worst."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.library import load_library
from conformance.cases import found
from conformance.cases.parameters import leaves
from conformance.cases.stream import Stream, norm
from conformance.check.engine import Backend
from conformance.search import corpus
from conformance.search.climb import ISLAND_LANES, climb, fresh_population
from conformance.search.mutation import from_ordered, mutated, ordered
from conformance.search.objective import Objective
from conformance.search.population import ROUNDED_UNIT, unpack, valid

LIBRARY = load_library()
NUMPY = Backend("numpy", "numpy", evaluate)
FUNCTIONS = ("strand_specular", "fakefur_shade", "pcg3d", "to_world", "fin_position", "hammersley")


def planted(library: Any, name: str, inputs: Any) -> Any:
    """The evaluator with an error that grows toward one place: y = 0.7 within x from 0.3 to 0.31."""
    got = np.asarray(evaluate(library, name, inputs))
    near = (inputs["x"] > 0.3) & (inputs["x"] < 0.31)
    return np.where(near, got + np.exp(-np.abs(inputs["y"] - 0.7)), got).astype(np.float32)


def test_order_of_floats_is_a_bijection() -> None:
    x = np.array([-3e38, -1.0, -1e-30, 0.0, 1e-30, 0.5, 3e38], np.float32)
    assert (np.diff(ordered(x)) > 0).all()
    assert np.array_equal(from_ordered(ordered(x)), x)
    assert from_ordered(ordered(np.float32(1.0)) + 1) == np.nextafter(np.float32(1.0), np.float32(2.0))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_children_stay_inside_the_domains(name: str) -> None:
    function = LIBRARY.function(name)
    parents = fresh_population(Objective(LIBRARY, name, NUMPY), 1, 8 * ISLAND_LANES)
    stream = Stream(1)
    changed = 0
    for _ in range(12):
        children = mutated(stream, function, parents, ISLAND_LANES)
        changed += sum(int((children[p] != parents[p]).any()) for p in parents)
        parents = children
    assert changed
    for leaf in leaves(function.parameters):
        values = parents[leaf.path]
        assert valid(leaf, values).all(), leaf.name
        if leaf.unit:
            assert np.abs(norm(values.astype(np.float64)) - 1.0).max() <= ROUNDED_UNIT


def test_a_planted_error_is_found_and_climbed() -> None:
    objective = Objective(LIBRARY, "safe_pow", Backend("numpy", "planted", planted))
    result = climb(objective, 0.0, seed=3, generations=40)
    worst = next(find for find in result.finds if find.bound.measure == "absolute")
    assert worst.ratio > 1e4
    assert 0.3 < float(worst.inputs["x"][0]) < 0.31
    assert abs(float(worst.inputs["y"][0]) - 0.7) < 0.05
    assert result.evaluations == 41 * 32 * ISLAND_LANES


def test_the_same_seed_finds_the_same() -> None:
    objective = Objective(LIBRARY, "sin_angle", NUMPY)
    first, second = (climb(objective, 0.0, seed=5, generations=6) for _ in range(2))
    texts = [
        [found.words(objective.function, find.inputs) for find in search.finds] for search in (first, second)
    ]
    assert texts[0] == texts[1]


def test_only_worse_finds_replace_what_is_stored(tmp_path: Path) -> None:
    objective = Objective(LIBRARY, "sin_angle", NUMPY)
    finds = climb(objective, 0.0, seed=5, generations=4).finds
    assert corpus.keep(LIBRARY, finds, tmp_path) == len(finds)
    assert corpus.keep(LIBRARY, finds, tmp_path) == 0
    before = (tmp_path / "direction.csv").read_bytes()
    milder = [type(find)(**{**vars(find), "error": find.error / 2}) for find in finds]
    assert corpus.keep(LIBRARY, milder, tmp_path) == 0
    assert (tmp_path / "direction.csv").read_bytes() == before


SECTIONS = sorted(path.stem for path in found.FOLDER.glob("*.csv"))


@pytest.mark.parametrize("section", SECTIONS)
def test_stored_inputs_fit_their_functions(section: str) -> None:
    rows = found.rows(section)
    assert rows
    for row in rows:
        assert corpus.is_current(LIBRARY, row), f"{row['function']}: run python -m conformance.search"
        function = LIBRARY.function(row["function"])
        assert function.module == section
        assert found.words(function, found.inputs_of(function, [row["inputs"]])) == row["inputs"]


def test_words_of_other_parameters_are_refused() -> None:
    function = LIBRARY.function("sin_angle")
    with pytest.raises(ValueError, match="other parameters"):
        found.inputs_of(function, ["t=3f800000 00000000 00000000"])
    with pytest.raises(ValueError, match="components"):
        found.inputs_of(function, ["a=3f800000;b=3f800000 00000000 00000000"])


def test_structs_and_frames_survive_as_words() -> None:
    function = LIBRARY.function("to_world")
    population = fresh_population(Objective(LIBRARY, "to_world", NUMPY), 1, 64)
    inputs = unpack(leaves(function.parameters), population)
    text = found.words(function, inputs, 7)
    again = found.inputs_of(function, [text])
    assert found.words(function, again) == text
