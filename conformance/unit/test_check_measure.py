"""The measures of error, and the features that say where a bound applies.

Plan.
  errors     every measure on hand-made lanes: relative, floored, absolute, exact; vectors and structs
  NaN        a result that is not finite has an infinite error, an expected NaN never compares as good
  ulps       the spacing around the expected value, denormals counted at the smallest normal's spacing
  features   parameters, struct fields, components, angle to a line, dot, length; both ends belong to a domain
"""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from codegen.bounds import Bound
from codegen.errors import UserError
from conformance.check import measure
from conformance.check.features import applies, feature, lookup
from conformance.unit.support.tolerances import tolerance

INF, NAN = np.inf, np.nan


def bound(kind: str = "relative", **fields: Any) -> Bound:
    return Bound("probe", kind, fields.pop("bound", 1e-6), "everywhere", "this test", **fields)


def floats(*values: Any) -> npt.NDArray[np.float32]:
    return np.array(values, np.float32)


def doubles(*values: Any) -> npt.NDArray[np.float64]:
    return np.array(values, np.float64)


ERRORS = {
    "relative": (bound(), floats(1, 3, -4, 0, 2), doubles(2, 2, -2, 0, 2), [0.5, 0.5, 1.0, 0.0, 0.0]),
    "relative, zero expected": (bound(), floats(1e-3), doubles(0), [INF]),
    "relative, above the floor": (bound(floor=1.0), floats(3, -3), doubles(4, -4), [0.25, 0.25]),
    "relative, below the floor": (bound(floor=2.0), floats(0.5, 1), doubles(0.25, 0), [0.125, 0.5]),
    "absolute": (bound("absolute"), floats(1, -3), doubles(3, 3), [2.0, 6.0]),
    "absolute, floor ignored": (bound("absolute", floor=8.0), floats(1), doubles(3), [2.0]),
    "absolute, vectors": (
        bound("absolute"),
        floats([1, 2, 3], [0, 0, 0]),
        doubles([1, 5, 4], [1, 0, 0]),
        [3.0, 1.0],
    ),
    "relative, vectors": (bound(), floats([1, 2], [4, 1]), doubles([2, 2], [4, 4]), [0.5, 0.75]),
    "exact floats": (bound("exact"), floats(0.1, 0.1, 1), doubles(0.1, 0.2, 1), [0.0, INF, 0.0]),
    "exact, signs of zero are one": (bound("exact"), floats(-0.0), doubles(0.0), [0.0]),
    "exact vectors": (bound("exact"), floats([1, 2], [1, 2]), doubles([1, 2], [1, 3]), [0.0, INF]),
    "exact vectors, longer than many": (bound("exact"), floats([1, 2, 3]), doubles([1, 2, 4]), [INF]),
    "relative vectors, longer than many": (bound(), floats([2, 2, 6]), doubles([2, 2, 4]), [0.5]),
    "relative, too large for a double": (bound(), floats(1e30), doubles(1e-300), [INF]),
    "exact words": (
        bound("exact"),
        np.array([2**32 - 1, 7], np.uint32),
        np.array([2**32 - 1, 8], np.uint32),
        [0.0, INF],
    ),
    "exact words beside others": (
        bound("exact"),
        np.array([1], np.uint32),
        np.array([1 + 2**32], np.int64),
        [INF],
    ),
    "exact truth": (bound("exact"), np.array([True, False]), np.array([True, True]), [0.0, INF]),
    "not finite": (bound("absolute"), floats(NAN, INF, -INF, 1), doubles(1, INF, 1, 1), [INF, INF, INF, 0.0]),
    "relative, not finite": (bound(), floats(NAN, INF, -INF), doubles(1, INF, 1), [INF, INF, INF]),
    "one component not finite": (bound(), floats([1, NAN]), doubles([1, 1]), [INF]),
}


@pytest.mark.parametrize("name", ERRORS)
def test_error_of_every_lane(name: str) -> None:
    chosen, got, expected, errors = ERRORS[name]
    found = measure.error(chosen, got, expected)
    assert found.dtype == np.float64
    assert found.tolist() == errors


def test_expected_nan_is_never_small() -> None:
    for kind in ("relative", "absolute", "exact"):
        assert not measure.error(bound(kind), floats(1), doubles(NAN)) <= 1e30


def test_error_is_computed_in_double() -> None:
    """In float32 the difference would vanish."""
    found = measure.error(bound("absolute"), floats(1), doubles(1.0 + 1e-12))
    assert found[0] == pytest.approx(1e-12, rel=tolerance("lost_in_float32"), abs=0.0)


GOT = {"near": floats(1, 1), "far": floats([0, 0], [0, 5])}
EXPECTED = {"near": doubles(2, 1), "far": doubles([0, 1], [3, 0])}


@pytest.mark.parametrize(("field", "errors"), [("", [1.0, 5.0]), ("near", [1.0, 0.0]), ("far", [1.0, 5.0])])
def test_struct_counts_its_worst_field_or_the_named_one(field: str, errors: list[float]) -> None:
    assert measure.error(bound("absolute", field=field), GOT, EXPECTED).tolist() == errors


def test_first_field_counts_where_it_is_the_worse() -> None:
    """The worst of all fields, not the last one's."""
    got, expected = dict(reversed(GOT.items())), dict(reversed(EXPECTED.items()))
    assert measure.error(bound("absolute"), got, expected).tolist() == [1.0, 5.0]
    assert (
        measure.error(bound("absolute"), {"a": floats(9), "b": floats(1)}, {"a": doubles(0), "b": doubles(0)})
        == 9.0
    )


def test_unknown_field_is_an_error_with_its_name() -> None:
    with pytest.raises(KeyError, match=r"probe.*unknown field nowhere"):
        measure.error(bound("absolute", field="nowhere"), GOT, EXPECTED)


def test_finite_looks_at_every_component_and_field() -> None:
    words = np.array([1, 2, 3], np.uint32)
    assert measure.finite(floats(1, NAN, -INF)).tolist() == [True, False, False]
    assert measure.finite(floats([1, 2], [1, INF], [NAN, 2])).tolist() == [True, False, False]
    assert measure.finite(words).tolist() == [True] * 3
    mixed = {"a": floats(1, NAN, 1), "b": floats([1, 1], [1, 1], [1, INF]), "c": words}
    assert measure.finite(mixed).tolist() == [True, False, False]


def test_ulps_are_spacings_around_the_expected_value() -> None:
    one, step = np.float32(1), np.spacing(np.float32(1))
    got = floats(one + 3 * step, 1, -2, 0, 2.0**-126, -0.5)
    expected = doubles(1, 1 + 0.25 * float(step), -2 + float(step), 2.0**-149, 2.0**-149, 0.5)
    assert measure.ulps(got, expected).tolist() == [3.0, 0.25, 1.0, 1.0, 2.0**23 - 1, 2.0**24]


def test_ulps_of_a_result_that_is_not_finite() -> None:
    assert measure.ulps(floats(INF), doubles(1)) == INF
    assert np.isnan(measure.ulps(floats(NAN, INF), doubles(1, INF))).tolist() == [True, True]


INPUTS: dict[str, Any] = {
    "x": floats(-1, 0, 2),
    "a": floats([1, 0, 0], [1, 0, 0], [3, 4, 12]),
    "b": floats([0, 2, 0], [-5, 0, 0], [0, 0, 1]),
    "tiny": floats([1e-30, 0, 0], [0, 1e-30, 0], [0, 0, 0]),
    "u": floats([1, 2], [3, 4], [5, 6]),
    "p": {"inner": {"share": floats(0.25, 0.5, 0.75)}, "w": floats([0, 1, 0], [1, 1, 0], [0, 0, 2])},
}
FEATURES = {
    "x": [-1.0, 0.0, 2.0],
    "p.inner.share": [0.25, 0.5, 0.75],
    "u.y": [2.0, 4.0, 6.0],
    "p.w.z": [0.0, 0.0, 2.0],
    "a.z": [0.0, 0.0, 12.0],
    "length(a)": [1.0, 1.0, 13.0],
    "apart(x, p.inner.share)": [1.25, 0.5, 1.25],
    "dot(a, b)": [0.0, -5.0, 12.0],
    "dot(a,p.w)": [0.0, 1.0, 24.0],
    "angle(a, b)": [np.pi / 2, 0.0, np.arctan2(5.0, 12.0)],
    "angle(b, p.w)": [0.0, np.pi / 4, 0.0],
    "angle(tiny, p.w)": [np.pi / 2, np.pi / 4, 0.0],
}


@pytest.mark.parametrize("text", FEATURES)
def test_feature_of_every_lane(text: str) -> None:
    found = feature(INPUTS, text)
    assert found.dtype == np.float64
    assert found == pytest.approx(FEATURES[text], rel=tolerance("rounded"), abs=0.0)


@pytest.mark.parametrize("shrunk", [1.0, 1e-30, 1e30])
def test_small_angles_keep_their_digits(shrunk: float) -> None:
    """An angle of 1e-9 to the line, whichever way the vector points and however long it is."""
    a = doubles([1, 1e-9, 0], [-1, 1e-9, 0]) * shrunk
    b = doubles([4, 0, 0], [4, 0, 0]) / shrunk
    assert feature({"a": a, "b": b}, "angle(a, b)") == pytest.approx(
        [1e-9, 1e-9], rel=tolerance("rounded"), abs=0.0
    )


@pytest.mark.parametrize("text", ["y", "p.outer", "x.x", "u.z", "p.inner.share.x", "a.w"])
def test_unknown_feature_is_refused(text: str) -> None:
    with pytest.raises(UserError, match="a bound speaks of an unknown input"):
        lookup(INPUTS, text)


def test_unknown_feature_suggests_its_neighbour() -> None:
    with pytest.raises(UserError, match=r'unknown input "p\.innr"; did you mean "inner"'):
        lookup(INPUTS, "p.innr")


@pytest.mark.parametrize(
    ("where", "mask"),
    [
        ({}, [True, True, True]),
        ({"x": (-1.0, 0.0)}, [True, True, False]),
        ({"x": (0.0, 2.0)}, [False, True, True]),
        ({"x": (-0.5, 1.5)}, [False, True, False]),
        ({"x": (-1.0, 0.0), "u.x": (3.0, 9.0)}, [False, True, False]),
        ({"u.x": (3.0, 9.0), "x": (-1.0, 0.0)}, [False, True, False]),
        ({"x": (5.0, 9.0)}, [False, False, False]),
    ],
)
def test_bound_applies_inside_every_interval(where: dict[str, tuple[float, float]], mask: list[bool]) -> None:
    assert applies(bound(where=where), INPUTS, 3).tolist() == mask


def test_nan_lies_in_no_domain() -> None:
    assert not applies(bound(where={"x": (-INF, INF)}), {"x": floats(NAN)}, 1).any()
