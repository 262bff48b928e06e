"""The strand references keep what the theory says: definition, cone, symmetries, degenerate values."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from conformance import cases
from conformance.cases.stream import Stream, single
from conformance.reference import REFERENCES, ambiguous, reference_for, strand
from conformance.unit.reference.checks import bound
from conformance.unit.reference.signatures import FUNCTIONS

TRIPLES = (
    "uniform",
    "axis_triples",
    "cone_triples",
    "cone_axis_triples",
    "azimuth_triples",
    "dark_side_triples",
)
X, Y, Z = (np.eye(3, dtype=np.float32)[None, k] for k in range(3))


def triples(family: str, n: int = 400) -> tuple[Any, Any, Any]:
    inputs = cases.draw(FUNCTIONS["strand_cosine"], family, n, 3)
    return inputs["t"], inputs["l"], inputs["v"]


def largest(x: npt.ArrayLike) -> float:
    return float(np.abs(np.asarray(x)).max())


@pytest.mark.parametrize("family", TRIPLES)
def test_closed_form_is_the_maximum_over_normals(family: str) -> None:
    t, l, v = triples(family)
    brute = strand.strand_cosine_brute(t, l, v)
    assert largest(brute - strand.strand_cosine(t, l, v)) <= bound("brute_force")


@pytest.mark.parametrize("family", TRIPLES)
def test_identities(family: str) -> None:
    t, l, v = triples(family)
    value = strand.strand_cosine(t, l, v)
    eps = bound("identity")
    assert largest(strand.strand_cosine_banks_printed(t, l, v) + value) <= eps
    assert largest(strand.strand_cosine_kajiya_printed(t, l, -v) - value) <= eps
    assert largest(strand.strand_cosine(t, v, l) - value) <= eps
    assert largest(strand.strand_cosine(-t, l, v) - value) <= eps
    assert largest(1.0 - strand.strand_angles(t, l, v)["defect"] - value) <= eps
    kappa = strand.strand_azimuth_cosine(t, l, v)
    assert largest(kappa) <= 1.0
    assert largest(strand.strand_azimuth_cosine(-t, v, l) - kappa) <= eps


def test_rotation_changes_nothing() -> None:
    t, l, v = triples("uniform")
    stream = Stream(11)
    normal = stream.directions(len(t))
    tangent = stream.across(normal)
    basis = np.stack([tangent, np.cross(normal, tangent), normal], axis=1)
    turned = [single(np.einsum("nij,nj->ni", basis, x.astype(np.float64))) for x in (t, l, v)]
    difference = strand.strand_cosine(*turned) - strand.strand_cosine(t, l, v)
    assert largest(difference) <= bound("rotation")


def test_one_on_the_cone() -> None:
    points = cases.load("cone_triples")
    t, l, v = (points[role].astype(np.float64) for role in "tlv")
    off = np.abs(strand.strand_angles(t, l, v)["cos_l"] + strand.strand_angles(t, l, v)["cos_v"])
    on_cone = off < bound("highlight")
    assert on_cone.sum() > 20
    assert largest(strand.strand_cosine(t, l, v)[on_cone] - 1.0) <= bound("highlight")


def test_specular_at_exponent_zero_is_one_also_in_the_dark() -> None:
    zero, one = np.zeros(1, np.float32), np.ones(1, np.float32)
    assert strand.strand_specular(X, X, X, zero) == 1.0
    assert strand.strand_specular(X, X, X, one) == 0.0
    assert strand.strand_specular_half(X, X, zero) == 1.0
    assert strand.strand_specular_half(X, X, one) == 0.0


def test_azimuth_is_zero_on_the_strand() -> None:
    assert strand.strand_azimuth_cosine(X, X, Y) == 0.0
    assert strand.strand_azimuth_cosine(X, Y, -X) == 0.0
    assert strand.strand_azimuth_cosine(X, Y, Y) == 1.0
    assert strand.strand_azimuth_cosine(X, Y, -Y) == -1.0


def test_positive_shift_moves_the_highlight_toward_the_tip() -> None:
    # A strand along +x on a surface with normal +z: the highlight lies where t'.h = 0.
    shifted = strand.tangent_shift(X, Z, np.array([0.2]))
    assert shifted[0, 0] > 0.0
    assert shifted[0, 2] > 0.0
    assert np.dot(shifted[0], [-0.2, 0.0, 1.0]) == pytest.approx(0.0, abs=bound("identity"))


def test_paths_are_finite_and_documented() -> None:
    depth, nothing = np.ones(1, np.float32), np.zeros(1, np.float32)
    assert strand.coat_path_banks(depth, X, X) == strand.LARGEST_PATH
    assert strand.coat_path_slab(depth, X, -X) == strand.LARGEST_PATH
    assert strand.coat_path_slab(depth, X, Y) == strand.LARGEST_PATH
    assert strand.coat_path_banks(nothing, X, X) == 0.0
    assert strand.coat_path_slab(nothing, X, -X) == 0.0
    assert strand.coat_extinction(depth) == strand.LARGEST_PATH
    assert strand.coat_transmittance(strand.coat_extinction(depth), nothing) == 1.0


def test_map_tangent_along_the_normal_is_the_tangent() -> None:
    for z in (-1.0, 0.0, 1.0):
        assert np.array_equal(strand.tangent_from_map(Z, X, np.array([[0.0, 0.0, z]])), X)


def test_every_name_of_the_sections_has_a_reference() -> None:
    assert set(FUNCTIONS) <= set(REFERENCES)
    with pytest.raises(KeyError, match="no reference for nothing"):
        reference_for("nothing")


def test_references_take_the_catalogue_parameters() -> None:
    for name, function in FUNCTIONS.items():
        code = REFERENCES[name].__code__
        names = code.co_varnames[: code.co_argcount]
        if not name.startswith("sin_angle_"):
            assert names == tuple(p.name for p in function.parameters), name


@pytest.mark.parametrize("name", FUNCTIONS)
def test_finite_everywhere(name: str) -> None:
    for family in ("uniform", *cases.families_for(FUNCTIONS[name].parameters)):
        inputs = cases.draw(FUNCTIONS[name], family, 300, 5)
        value = reference_for(name)(*inputs.values())
        for part in value.values() if isinstance(value, dict) else [value]:
            assert np.isfinite(part).all(), family


def test_ambiguity_is_rare() -> None:
    for name, function in FUNCTIONS.items():
        inputs = cases.draw(function, "uniform", 2000, 5)
        assert ambiguous(name, inputs).mean() <= bound("ambiguity"), name


def test_same_and_opposite_numbers_are_not_ambiguous() -> None:
    for family in ("equal_directions", "opposite_directions"):
        points = cases.load(family)
        inputs = {"t": points["a"], "l": points["b"], "v": points["b"]}
        assert not ambiguous("strand_azimuth_cosine", inputs).any()
