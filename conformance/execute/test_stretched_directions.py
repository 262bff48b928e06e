"""Directions of length 1 +- 1e-3 on every target: results change in proportion to the departure, no faster.

Plan. Each function with directions gets the stored family stretched_directions, all else held fixed. Against
the same directions normalised, its value changes by no more than slope * departure, with slopes as data.
Directions that are nearly parallel, where stretching decides what is left, must only give finite values.
"""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.library import load_library
from conformance import cases
from conformance.cases.parameters import Leaf, leaves, nested
from conformance.reference import ambiguous
from conformance.statistics.device import device_call
from conformance.statistics.evaluator import Array
from targets import TimedRuntime

CHECKS: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("stretched_directions.toml").read_text(encoding="utf-8")
)
LIBRARY = load_library()
POINTS = cases.load("stretched_directions")
COUNT = len(POINTS["a"])


def fixed(leaf: Leaf) -> Any:
    """The value at which a parameter that is no direction is held."""
    if leaf.type == "f32":
        return np.full(COUNT, CHECKS["parameters"].get(leaf.name, 0.5), np.float32)
    if leaf.type in ("vec2", "vec3"):
        return np.full((COUNT, int(leaf.type[-1])), 0.4, np.float32)
    return np.zeros(COUNT, np.uint32)


def normalised(x: Any) -> Any:
    """Rows as unit vectors, rounded to float32."""
    wide = np.asarray(x, dtype=np.float64)
    return (wide / np.linalg.norm(wide, axis=1, keepdims=True)).astype(np.float32)


def stretched_and_unit(name: str) -> tuple[dict[str, Any], dict[str, Any], list[Array]]:
    """Inputs with stretched directions, inputs with unit ones, and the stretched directions."""
    stretched: dict[tuple[str, ...], Any] = {}
    unit: dict[tuple[str, ...], Any] = {}
    directions: list[Array] = []
    free = iter("abcd" * 2)
    for leaf in leaves(LIBRARY.function(name).parameters):
        value = POINTS[next(free)] if leaf.unit else fixed(leaf)
        stretched[leaf.path] = value
        unit[leaf.path] = normalised(value) if leaf.unit else value
        if leaf.unit:
            directions.append(value.astype(np.float64))
    return nested(stretched), nested(unit), directions


def flat(value: Any) -> Array:
    """All components of a result as one row for each lane."""
    if isinstance(value, Mapping):
        return np.concatenate([flat(part) for part in value.values()], axis=1)
    return np.asarray(value, dtype=np.float64).reshape(COUNT, -1)


@pytest.mark.parametrize("name", CHECKS["slopes"])
def test_change_grows_with_the_departure(runtime: TimedRuntime, name: str) -> None:
    call = device_call(LIBRARY, runtime)
    stretched, unit, directions = stretched_and_unit(name)
    got, expected = flat(call(name, stretched)), flat(call(name, unit))
    assert np.isfinite(got).all()
    departure = np.max([np.abs(np.linalg.norm(x, axis=1) - 1.0) for x in directions], axis=0)
    separate = np.full(COUNT, True)
    for a, b in itertools.combinations(directions, 2):
        separate &= np.linalg.norm(np.cross(a, b), axis=1) > CHECKS["separation"]
    base = LIBRARY.function(name).base
    judged = separate & ~ambiguous(name, stretched, base) & ~ambiguous(name, unit, base)
    scale = np.maximum(np.abs(expected).max(axis=1), 1.0)
    allowed = (CHECKS["slopes"][name] * departure + CHECKS["rounding"]) * scale
    excess = np.where(judged, np.abs(got - expected).max(axis=1) - allowed, -1.0)
    worst = int(np.argmax(excess))
    assert excess[worst] <= 0.0, (worst, departure[worst], got[worst], expected[worst])


def test_every_base_function_of_directions_has_a_slope() -> None:
    def takes_directions(name: str) -> bool:
        found = leaves(LIBRARY.function(name).parameters)
        return any(leaf.unit for leaf in found) and all(leaf.type != "Frame" for leaf in found)

    functions = [LIBRARY.function(name) for name in LIBRARY.public if takes_directions(name)]
    in_sections = [
        f for f in functions if f.module.split(".")[0] in CHECKS["sections"] and f.kind != "variant"
    ]
    assert {f.name for f in in_sections} <= set(CHECKS["slopes"])
