"""References of directions and numbers: documented values and the properties that define them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from conformance import cases
from conformance.reference import ambiguous, direction, numeric
from conformance.unit.reference.checks import bound
from conformance.unit.reference.signatures import FUNCTIONS


def largest(x: npt.ArrayLike) -> float:
    return float(np.abs(np.asarray(x)).max())


def check_frame(frame: dict[str, Any]) -> None:
    axes = np.stack([frame[name] for name in ("tangent", "bitangent", "normal")], axis=1)
    gram = np.einsum("nik,njk->nij", axes, axes)
    assert largest(gram - np.eye(3)) <= bound("identity")
    assert largest(np.cross(frame["tangent"], frame["bitangent"]) - frame["normal"]) <= bound("identity")


@pytest.mark.parametrize("family", ["uniform", "axis_aligned", "near_axes"])
def test_frame_from_normal_is_right_handed(family: str) -> None:
    inputs = cases.draw(FUNCTIONS["frame_from_normal"], family, 600, 1)
    check_frame(direction.frame_from_normal(inputs["n"]))


@pytest.mark.parametrize("family", ["uniform", "near_parallel", "equal_directions", "ulp_neighbours"])
def test_frame_from_tangent_is_right_handed(family: str) -> None:
    inputs = cases.draw(FUNCTIONS["frame_from_tangent"], family, 600, 1)
    check_frame(direction.frame_from_tangent(inputs["n"], inputs["t"]))


def test_parallel_tangent_falls_back_to_the_frame_of_the_normal() -> None:
    points = cases.load("equal_directions")
    frame = direction.frame_from_tangent(points["a"], points["b"])
    assert np.array_equal(frame["tangent"], direction.frame_from_normal(points["a"])["tangent"])


def test_half_vector_of_opposite_directions_is_the_fixed_vector() -> None:
    points = cases.load("opposite_directions")
    h = direction.half_vector(points["a"], points["b"])
    assert np.array_equal(h, direction.frame_from_normal(points["a"])["tangent"])


def test_half_vector_is_ambiguous_only_at_its_threshold() -> None:
    points = cases.load("half_vector_threshold")
    size = np.linalg.norm(points["a"].astype(np.float64) + points["b"], axis=1)
    doubtful = ambiguous("half_vector", {"l": points["a"], "v": points["b"]})
    assert doubtful.any()
    assert (np.abs(size[doubtful] - 1e-6) < bound("half_vector_threshold")).all()


def test_local_and_world_are_inverse() -> None:
    inputs = cases.draw(FUNCTIONS["to_local"], "uniform", 500, 2)
    frame, w = inputs["frame"], inputs["w"]
    there = direction.to_world(frame, direction.to_local(frame, w))
    assert largest(there - w) <= bound("rotation")


def test_projection_and_rejection_add_up() -> None:
    for family in ("uniform", "vector_lengths"):
        inputs = cases.draw(FUNCTIONS["line_rejection"], family, 500, 2)
        x, t = inputs["x"].astype(np.float64), inputs["t"]
        total = direction.line_component(x, t) + direction.line_rejection(x, t)
        size = np.maximum(np.abs(x).max(axis=1, keepdims=True), np.finfo(np.float32).tiny)
        assert largest((total - x) / size) <= bound("identity")


def test_documented_values_of_powers() -> None:
    assert numeric.safe_pow([0.0, -1.0, 0.0, -1.0, 2.0], [0.0, 0.0, 2.0, 2.0, 3.0]).tolist() == [
        1,
        1,
        0,
        0,
        8,
    ]
    assert numeric.pow_one_minus([0.0, 1.0, 2.0, 1.5], [1e5, 1.0, 0.0, 2.0]).tolist() == [1, 0, 1, 0]
    assert numeric.exprel_neg([0.0, 1e-30]).tolist() == [1, 1]


def test_documented_values_of_the_step() -> None:
    below, at, above = numeric.safe_smoothstep([1.0] * 3, [1.0] * 3, [0.5, 1.0, 2.0])
    assert (below, at, above) == (0.0, 1.0, 1.0)
    assert numeric.safe_smoothstep([1.0, 1.0], [0.0, 0.0], [0.0, 1.0]).tolist() == [1, 0]


def test_safe_normalize_of_any_length() -> None:
    x = cases.load("vector_lengths")["x"]
    y = numeric.safe_normalize(x, np.broadcast_to(np.array([0.0, 0.0, 1.0]), x.shape))
    assert largest(np.linalg.norm(y, axis=1) - 1.0) <= bound("identity")
