"""Hard-case families: stored as computed, finite, large enough, and drawn inside every parameter's domain."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from conformance import cases
from conformance.cases.domains import UNIT_TOLERANCE, contains
from conformance.cases.parameters import leaves
from conformance.cases.registry import build
from conformance.cases.stream import SMALLEST_NORMAL, neighbour
from conformance.cases.table import DATA, text
from conformance.unit.reference.checks import CHECKS
from conformance.unit.reference.signatures import (
    FUNCTIONS,
    Finite,
    Function,
    Interval,
    Length,
    Parameter,
    Struct,
    Unit,
)


@pytest.mark.parametrize("name", cases.FAMILIES)
def test_stored_file_is_reproduced_to_the_byte(name: str) -> None:
    family = cases.FAMILIES[name]
    assert (DATA / f"{name}.csv").read_bytes() == text(family, build(family)).encode("ascii")


@pytest.mark.parametrize("name", cases.FAMILIES)
def test_points_are_enough_finite_and_normal(name: str) -> None:
    points = cases.load(name)
    for role in cases.FAMILIES[name].roles:
        values = points[role.name]
        assert len(values) >= CHECKS["cases"]["points"]
        if values.dtype == np.uint32:
            continue
        assert np.isfinite(values).all()
        assert ((values == 0.0) | (np.abs(values) >= SMALLEST_NORMAL)).all()
        if role.unit:
            size = np.linalg.norm(values.astype(np.float64), axis=1)
            assert np.abs(size - 1.0).max() <= UNIT_TOLERANCE


def test_no_file_without_a_family() -> None:
    assert {path.stem for path in DATA.glob("*.csv")} == set(cases.FAMILIES)


def test_unknown_family_names_those_there_are() -> None:
    with pytest.raises(KeyError, match="near_parallel"):
        cases.load("nothing")
    with pytest.raises(KeyError, match="no family 'exponents'"):
        cases.draw(FUNCTIONS["sin_angle"], "exponents", 4, 0)


def check_inside(function: Any, inputs: dict[str, Any]) -> None:
    """Every value lies in its parameter's domain; frames are orthonormal by construction."""
    for leaf in leaves(function.parameters):
        values: Any = inputs
        for name in leaf.path:
            values = values[name]
        if leaf.type == "Frame":
            assert set(values) == {"tangent", "bitangent", "normal"}
        else:
            assert values.dtype == np.float32
            assert contains(leaf.domain, values).all(), leaf.name


@pytest.mark.parametrize("name", FUNCTIONS)
def test_draws_stay_inside_the_domains(name: str) -> None:
    function = FUNCTIONS[name]
    for family in (cases.UNIFORM, *cases.families_for(function.parameters)):
        inputs = cases.draw(function, family, 150, 1)
        assert list(inputs) == [p.name for p in function.parameters]
        check_inside(function, inputs)


def test_draws_repeat_with_the_seed() -> None:
    function = FUNCTIONS["strand_specular"]
    first, second, other = (cases.draw(function, "highlight_flanks", 64, seed) for seed in (1, 1, 2))
    assert all(np.array_equal(first[name], second[name]) for name in first)
    assert not np.array_equal(first["t"], other["t"])


def test_coverage_uses_every_point_with_every_parameter() -> None:
    function = FUNCTIONS["strand_cosine"]
    count = cases.coverage(function, "near_parallel")
    points = cases.load("near_parallel")
    assert count == 3 * len(points["a"])
    inputs = cases.draw(function, "near_parallel", count, 1)
    for first, second, lane in (("t", "l", 0), ("t", "v", 1), ("l", "v", 2)):
        drawn = np.concatenate([inputs[first][lane::3], inputs[second][lane::3]], axis=1)
        stored = np.concatenate([points["a"], points["b"]], axis=1)
        assert np.array_equal(np.unique(drawn, axis=0), np.unique(stored, axis=0))


def test_families_are_chosen_by_name_type_and_domain() -> None:
    chosen = {name: cases.families_for(function.parameters) for name, function in FUNCTIONS.items()}
    assert "exponents" in chosen["scheuermann_shade"]
    assert "cone_triples" in chosen["banks_shade"]
    assert "grazing_triples" in chosen["banks_shade"]
    assert "smoothstep_edges" in chosen["safe_smoothstep"]
    assert "vector_lengths" in chosen["safe_normalize"]
    assert "cone_triples" not in chosen["sin_angle"]
    assert "bessel_arguments" in chosen["bessel_i0e"]
    assert all(families[0] == cases.DOMAIN_ENDS for families in chosen.values())


def test_domain_ends_hold_ends_and_their_neighbours() -> None:
    function = Function("f", (Parameter("x", "f32", Interval(0.1, 3.0)),))
    drawn = set(cases.draw(function, cases.DOMAIN_ENDS, 400, 1)["x"].tolist())
    low, high = np.float32(0.1), np.float32(3.0)
    assert {float(low), float(high), 1.0} <= drawn
    assert {float(neighbour(low, 1)[0]), float(neighbour(high, -1)[0])} <= drawn


def test_all_types_and_domains_are_drawn() -> None:
    coat = Struct(
        "Coat", (Parameter("density", "f32", Interval(0.0, 1e6, "log")), Parameter("bend", "vec3", None))
    )
    function = Function(
        "f",
        (
            Parameter("coat", coat, None),
            Parameter("u", "vec2", Interval(0.0, 1.0 - 2.0**-24)),
            Parameter("x", "u32", None),
            Parameter("cells", "uvec3", Interval(0.0, 100.0)),
            Parameter("steps", "i32", Interval(-5.0, 5.0)),
            Parameter("edge", "vec3", Length(1e-6, 1e6)),
            Parameter("w", "vec3", Unit()),
            Parameter("free", "f32", Finite()),
            Parameter("flag", "bool", None),
        ),
    )
    for family in (cases.UNIFORM, *cases.families_for(function.parameters)):
        inputs = cases.draw(function, family, 50, 1)
        assert inputs["coat"]["density"].shape == (50,)
        assert inputs["coat"]["bend"].shape == (50, 3)
        assert inputs["u"].shape == (50, 2)
        assert inputs["x"].dtype == np.uint32
        assert inputs["cells"].shape == (50, 3)
        assert inputs["cells"].max() <= 100
        assert inputs["steps"].dtype == np.int32
        assert inputs["flag"].dtype == np.bool_
        assert np.isfinite(inputs["free"]).all()
    assert {"words", "unit_squares", "axis_aligned", "vector_lengths"} <= set(
        cases.families_for(function.parameters)
    )


def test_related_parameters_respect_each_other() -> None:
    function = Function(
        "f", (Parameter("i", "u32", None), Parameter("n", "u32", Interval(1.0, 2.0**20, "log")))
    )
    for family in (cases.UNIFORM, cases.DOMAIN_ENDS, "sequence_indices"):
        inputs = cases.draw(function, family, 500, 1)
        assert (inputs["i"] < inputs["n"]).all()
