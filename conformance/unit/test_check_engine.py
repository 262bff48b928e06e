"""The verdict "within bound": what passes, what fails, and that a failure says all that replaying it needs.

Plan. A one-function library with bounds of its own, a backend and a reference that return given numbers, so
that every count of the result is known beforehand. Intervals are left out: see test_check_interval.py.
  judged     the bound itself still passes; anything above it, NaN among it, fails; other lanes stay unjudged
  draws      several draws add up: no tolerance carries over, the worst lane is the worst of all
  exempt     ambiguous lanes and lanes outside every bound are counted, yet must be finite
  figures    maximum, p99.9, median and number of lanes of each bound
  failures   at most MAX_FAILURES in full, worst first; each with identity, inputs, error, bound, origin
  refused    no bound, no reference
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.library import Library, load_library
from conformance.check import engine, prepared
from conformance.check.engine import Backend, Draw, check_function
from conformance.check.failure import FINITE, WITHIN
from conformance.check.result import FunctionResult
from conformance.reference import PROPERTY_ONLY
from conformance.unit.support.sources import library_of
from conformance.unit.support.tolerances import tolerance

SOURCE = "def probe(x: X) -> f32:\n    return x\n"
BOUND = '[[probe]]\nmeasure = "absolute"\nbound = 0.5\ndomain = "{}"\norigin = "{}"\n{}\n'
ALL = BOUND.format("everywhere", "derived here", "")
Floats = list[float]


def library_with(folder: Path, bounds: str, source: str = SOURCE) -> Library:
    library = library_of(folder, source)
    (folder / "numeric/bounds.toml").write_text(bounds, encoding="utf-8")
    return library


@pytest.fixture
def check(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., FunctionResult]:
    """check(bounds, draws): the verdict where every draw lists (input, result, expected) lane by lane."""

    def run(
        bounds: str,
        *draws: list[tuple[float, float, float]],
        target: str = "numpy",
        doubtful: Callable[[Any], Any] | None = None,
    ) -> FunctionResult:
        library = library_with(tmp_path, bounds)
        tables = [np.array(d, np.float64).T for d in draws]
        made = [
            Draw(f"draw{k}", len(t[0]), 7 + k, {"x": t[0].astype(np.float32)}) for k, t in enumerate(tables)
        ]
        results, wanted = (np.concatenate([t[k] for t in tables]) for k in (1, 2))
        monkeypatch.setattr(prepared, "find_reference", lambda *_: lambda x: wanted)
        if doubtful is not None:
            monkeypatch.setattr(prepared, "ambiguous", lambda name, inputs, base: doubtful(inputs["x"]))
        on = Backend(target, "a driver", lambda *_: results.astype(np.float32))
        return check_function(library, "probe", on, made, intervals=False)

    return run


Check = Callable[..., FunctionResult]


def test_bound_itself_passes_and_more_fails(check: Check) -> None:
    result = check(ALL, [(0, 1.5, 1), (1, 0.5, 1), (2, 1, 1)])
    assert result.passed
    assert not result.failures
    (found,) = result.bounds
    assert (found.measured, found.lanes, found.failures, found.limit) == (0.5, 3, 0, 0.5)

    result = check(ALL, [(0, 1.5, 1), (1, 1, 1), (2, 1.5001, 1), (3, 0.25, 1)])
    assert not result.passed
    assert [f.identity.lane for f in result.failures] == [3, 2]
    assert result.bounds[0].failures == 2


def test_relative_errors_are_relative_to_what_is_expected(check: Check) -> None:
    relative = ALL.replace("absolute", "relative")
    result = check(relative, [(0, 2.0, 4.0), (1, 8.0, 4.0), (2, 5.0, 4.0)])
    assert [f.identity.lane for f in result.failures] == [1]
    assert result.bounds[0].measured == 1.0


def test_expected_nan_fails(check: Check) -> None:
    result = check(ALL, [(0, 1, np.nan), (1, 1, 1)])
    assert [f.identity.lane for f in result.failures] == [0]


def test_figures_are_over_all_draws(check: Check) -> None:
    first = [(k, k / 4096, 0.0) for k in range(1000)]
    result = check(ALL, first, [(5000, 0.375, 0.0)], [(7000, 0.25, 0.0)])
    (found,) = result.bounds
    errors = [k / 4096 for k in range(1000)] + [0.375, 0.25]
    assert found.lanes == result.lanes == 1002
    assert found.measured == 0.375
    assert found.worst == "x = 5000 [459c4000]"
    assert found.median == pytest.approx(float(np.median(errors)), rel=tolerance("rounded"))
    assert found.p999 == sorted(errors)[1000]
    assert found.bound == "absolute <= 0.5: everywhere"
    assert 0.0 < result.seconds < 600.0
    assert (result.function, result.target, result.driver) == ("probe", "numpy", "a driver")


def test_worst_lane_is_found_among_many(check: Check) -> None:
    narrow = BOUND.format("low", "derived", "where = { x = [0, 2] }")
    result = check(narrow, [(0, 0.125, 0.0), (1, 0.375, 0.0), (2, 0.25, 0.0), (3, 9.0, 0.0)])
    assert result.bounds[0].measured == 0.375
    assert result.bounds[0].worst.startswith("x = 1 ")


def test_failure_of_words_has_no_ulps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    exact = '[[probe]]\nmeasure = "exact"\ndomain = "all"\norigin = "derived"\n'
    library = library_with(tmp_path, exact, "def probe(n: u32) -> u32:\n    return n\n")
    inputs = {"n": np.array([1, 2], np.uint32)}
    monkeypatch.setattr(prepared, "find_reference", lambda *_: lambda n: n)
    on = Backend("numpy", "a driver", lambda *_: np.array([1, 3], np.uint32))
    (failure,) = check_function(library, "probe", on, [Draw("d", 2, 0, inputs)], intervals=False).failures
    assert failure.identity.lane == 1
    assert [m.error for m in failure.missed] == ["exact inf exceeds 0"]
    assert failure.distance == ""


def test_figures_of_infinite_errors_are_infinite(check: Check) -> None:
    exact = '[[probe]]\nmeasure = "exact"\ndomain = "all"\norigin = "derived"\n'
    (found,) = check(exact, [(k, k, k + 1.0) for k in range(5000)]).bounds
    assert found.measured == found.p999 == found.median == np.inf
    assert found.failures == 5000


def test_numbers_of_a_failure_are_short(check: Check) -> None:
    (failure,) = check(ALL.replace("0.5", "0.123456789"), [(0, 1.0 / 3.0, 0.0)]).failures
    assert failure.missed[0].error == "absolute 0.3333 exceeds 0.1235"


def test_worst_lane_is_kept_even_where_all_is_exact(check: Check) -> None:
    result = check(ALL, [(3, 1, 1)], [(4, 1, 1)])
    assert result.bounds[0].worst.startswith("x = 3 ")
    assert result.bounds[0].measured == 0.0


def test_no_tolerance_carries_over_to_the_next_draw(check: Check) -> None:
    """The same wrong lane fails in the tenth draw as in the first, and after large permitted errors."""
    good, bad = [(0, 0.4375, 0.0)], [(1, 0.625, 0.0)]
    assert not check(ALL, *[good] * 9, bad).passed
    assert not check(ALL, bad, *[good] * 9).passed
    assert check(ALL, *[good] * 10).passed
    result = check(ALL, *[bad] * 3)
    assert [f.identity.family for f in result.failures] == ["draw0", "draw1", "draw2"]
    assert result.bounds[0].failures == 3


def test_result_that_is_not_finite_fails_everywhere(check: Check) -> None:
    inside = BOUND.format("positive", "derived", "where = { x = [0, 9] }")
    result = check(inside, [(1, np.nan, 1), (-1, np.inf, 1), (2, 1, 1), (3, -np.inf, 1)])
    assert not result.passed
    assert result.non_finite == 3
    assert [f.identity.lane for f in result.failures] == [0, 1, 3]
    assert {f.reason for f in result.failures} == {"the result is not finite"}
    assert {f.failed for f in result.failures} == {(FINITE,)}
    assert all("every finite input must give a finite result" in f.lines()[-2] for f in result.failures)
    assert result.bounds[0].lanes == 1


def test_ambiguous_lanes_are_exempt_but_must_be_finite(check: Check) -> None:
    result = check(ALL, [(1, 99, 1), (2, 1, 1)], doubtful=lambda x: x == 1)
    assert result.passed
    assert (result.ambiguous, result.uncovered, result.bounds[0].lanes) == (1, 0, 1)
    assert not check(ALL, [(1, np.nan, 1), (2, 1, 1)], doubtful=lambda x: x == 1).passed


def test_lanes_outside_every_bound_are_counted(check: Check) -> None:
    low = BOUND.format("low", "derived", "where = { x = [0, 1] }")
    high = BOUND.format("high", "derived", "where = { x = [3, 4] }")
    lanes = [(0, 9, 0), (0.5, 0, 0), (2, 9, 0), (5, 9, 0), (3, 0.25, 0), (4, 0.125, 0)]
    result = check(low + high, lanes)
    assert [f.identity.lane for f in result.failures] == [0]
    assert result.uncovered == 2
    assert [b.lanes for b in result.bounds] == [2, 2]
    assert [b.measured for b in result.bounds] == [9.0, 0.25]
    assert [b.failures for b in result.bounds] == [1, 0]
    again = check(low + high, lanes, lanes, doubtful=lambda x: x == 2)
    assert (again.uncovered, again.ambiguous, again.lanes) == (2, 2, 12)


def test_bound_without_a_lane_stays_empty(check: Check) -> None:
    result = check(ALL + BOUND.format("nowhere", "derived", "where = { x = [50, 60] }"), [(0, 0, 0)])
    assert result.passed
    assert (result.bounds[1].lanes, result.bounds[1].worst) == (0, "")


def test_overlapping_bounds_are_judged_each(check: Check) -> None:
    tight = BOUND.format("tight", "derived", "where = { x = [0, 1] }").replace("0.5", "0.125")
    result = check(ALL + tight, [(0, 0.25, 0), (2, 0.25, 0)])
    assert [b.failures for b in result.bounds] == [0, 1]
    assert [[m.bound for m in f.missed] for f in result.failures] == [["absolute <= 0.125: tight"]]


def test_accuracy_is_measured_where_any_bound_holds(check: Check) -> None:
    low, high = (
        BOUND.format("a part", "derived", f"where = {{ x = {ends} }}") for ends in ("[0, 1]", "[2, 3]")
    )
    result = check(low + high, [(0, 1.25, 1), (1, 1, 1), (2, 1.25, 1), (9, 5, 1)])
    assert [a.lanes for a in result.accuracy] == [3]
    assert [b.lanes for b in result.bounds] == [2, 1]


def test_failures_of_several_bounds_come_in_the_order_of_the_worst(check: Check) -> None:
    share = BOUND.format("a share", "derived", "").replace("absolute", "relative").replace("0.5", "0.125")
    result = check(ALL + share, [(0, 3, 1), (1, 120, 100)])
    assert [f.identity.lane for f in result.failures] == [1, 0], "40 and 1.6 times its bounds before 4 and 16"
    result = check(ALL + share, [(0, 103, 100), (1, 2, 1)])
    assert [f.identity.lane for f in result.failures] == [1, 0], (
        "2 and 8 times before 6, though 3 is more than 1"
    )


def test_error_may_be_any_number_of_times_its_bound(check: Check) -> None:
    result = check(ALL.replace("0.5", "1e-300"), [(0, 1e30, 0), (1, 0, 0)])
    assert [(f.identity.lane, f.failed) for f in result.failures] == [(0, (WITHIN,))]


def test_whatever_may_be_imported_is_there() -> None:
    assert all(hasattr(engine, name) for name in engine.__all__)


def test_program_is_kept_with_failures_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    library = library_with(tmp_path, ALL)
    monkeypatch.setattr(prepared, "find_reference", lambda *_: lambda x: x)
    draws = [Draw("draw", 2, 7, {"x": np.ones(2, np.float32)})]
    for error, kept in ((0.0, ""), (2.0, "the text")):
        on = Backend("numpy", "d", lambda *given, e=error: given[2]["x"] + e, text=lambda *_: "the text")
        result = check_function(library, "probe", on, draws, intervals=False)
        assert result.program == kept
        assert len(result.emitted) == 16


def test_bounds_of_other_targets_are_left_out(check: Check) -> None:
    mine = ALL.replace("0.5", "4.0") + 'targets = ["glsl", "opencl"]\n'
    other = ALL + 'targets = ["wgsl"]\n'
    lanes = [(0, 2, 0)]
    assert check(mine + other, lanes, target="opencl").passed
    assert not check(mine + other, lanes, target="wgsl").passed
    assert "declares no error bound for numpy" in check(mine + other, lanes).broken


def test_failures_are_reported_worst_first_and_counted_beyond_the_limit(check: Check) -> None:
    lanes = [(k, k, 0.0) for k in range(10)]
    result = check(ALL, lanes, lanes)
    assert [f.identity.lane for f in result.failures] == [9, 9, 8, 8, 7]
    assert engine.MAX_FAILURES == 5
    assert result.bounds[0].failures == 18
    mixed = check(ALL, [(k, np.nan, 0.0) for k in range(3)], lanes)
    assert [(f.identity.family, f.identity.lane) for f in mixed.failures] == [
        ("draw0", 0),
        ("draw0", 1),
        ("draw0", 2),
        ("draw1", 9),
        ("draw1", 8),
    ]
    many = check(ALL, lanes, [(k, np.nan, 0.0) for k in range(3)])
    assert [f.identity.family for f in many.failures] == ["draw1"] * 3 + ["draw0"] * 2
    assert many.non_finite == 3


def test_failure_says_what_replaying_needs(check: Check) -> None:
    result = check(ALL, [(0, 0.4, 1e-30), (0.1, 3, 1), (0, 0.4, 1e-30)])
    (failure,) = result.failures
    assert str(failure.identity) == "probe/numpy/draw0/3/7/1"
    assert failure.lines() == [
        "probe on a driver: outside its declared bound",
        "  inputs     x = 0.100000001 [3dcccccd]",
        "  got        3 [40400000]",
        f"  reference  1 ({2.0**24:.4g} ULP away)",
        "  exact      0.10000000149011612 (the same program in 50 digits)",
        "  bound      MISSED: absolute 2 exceeds 0.5; declared: absolute <= 0.5: everywhere",
        "             origin: derived here",
        "  replay     vair check --replay probe/numpy/draw0/3/7/1",
    ]
    data = result.as_data()
    assert (data["passed"], data["lanes"], data["broken"]) == (False, 3, None)
    assert data["failures"][0]["identity"] == "probe/numpy/draw0/3/7/1"


PAIR = """
@struct
class Pair:
    \"\"\"Two.

    low   first
    high  second
    \"\"\"

    low: X
    high: V

def probe(x: X) -> Pair:
    return Pair(x, vec3(x))
"""


def test_struct_failure_shows_the_field_of_the_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    library = library_with(tmp_path, ALL + 'field = "high"\n', PAIR)
    got = {"low": np.array([9, 9], np.float32), "high": np.array([[0, 0, 0], [0, 1, 0]], np.float32)}
    expected = {"low": np.zeros(2), "high": np.zeros((2, 3))}
    monkeypatch.setattr(prepared, "find_reference", lambda *_: lambda x: expected)
    on = Backend("numpy", "a driver", lambda *_: got)
    drawn = [Draw("d", 2, 0, {"x": np.array([1, 2], np.float32)})]
    (failure,) = check_function(library, "probe", on, drawn, intervals=False).failures
    assert failure.identity.lane == 1
    (missed,) = failure.missed
    assert missed.error == "absolute 1 exceeds 0.5"
    assert failure.distance == f"low {9 * 2.0**149:.4g} ULP, high {2.0**149:.4g} ULP"
    assert missed.bound.startswith("high: ")
    assert failure.got == "{low: 9 [41100000], high: (0, 1, 0) [00000000 3f800000 00000000]}"


def test_function_without_reference_is_broken(tmp_path: Path) -> None:
    result = check_function(library_with(tmp_path, ALL), "probe", engine.backend("numpy"), [])
    assert not result.passed
    assert result.broken == "probe has no reference"


def test_function_without_bound_is_broken(tmp_path: Path) -> None:
    result = check_function(library_of(tmp_path, SOURCE), "probe", engine.backend("numpy"), [])
    assert not result.passed
    assert result.broken == "probe declares no error bound for numpy"


def test_reference_is_the_functions_own_or_its_bases() -> None:
    library = load_library()
    references = {f.name: engine.find_reference(library, f) for f in library.functions.values()}
    assert references["sin_angle_cosine"] is references["sin_angle"] is not None
    assert references["strand_cosine_banks_printed"] is not references["strand_cosine"]


def test_only_variants_take_the_reference_and_the_exemptions_of_their_base(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    library = load_library()
    base = library.function("half_vector")
    variant = replace(base, name="probe_other", kind="variant", base="half_vector")
    printed = replace(variant, kind="printed")
    assert engine.find_reference(library, variant) is engine.find_reference(library, base) is not None
    assert engine.find_reference(library, printed) is None
    asked: list[tuple[str, str | None]] = []

    def nothing(name: str, inputs: Any, of: str | None) -> Any:
        asked.append((name, of))
        return np.zeros(10, np.bool_)

    monkeypatch.setattr(prepared, "ambiguous", nothing)
    run = engine.backend("numpy").run
    for name in ("half_vector", "sin_angle_cosine", "strand_cosine_banks_printed"):
        check_function(
            library,
            name,
            Backend("numpy", "a driver", run),
            list(engine.draws(library.function(name), 10, 10))[:1],
            intervals=False,
        )
    others = [("sin_angle_cosine", "sin_angle"), ("strand_cosine_banks_printed", None)]
    assert asked == [("half_vector", None), *others]


def test_own_reference_of_a_variant_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    monkeypatch.setattr(prepared, "reference_for", lambda *names: asked.append(names))
    for name in ("sin_angle_half", "sin_angle"):
        prepared.find_reference(load_library(), load_library().function(name))
    assert asked == [("sin_angle_half", "sin_angle"), ("sin_angle", None)]


def test_function_that_no_formula_fixes_is_held_against_the_evaluator() -> None:
    library = load_library()
    (name,) = PROPERTY_ONLY
    inputs = engine.draw(library.function(name), "uniform", 50, 1).inputs
    reference = engine.find_reference(library, library.function(name))
    assert reference is not None
    assert np.array_equal(reference(*inputs.values()), engine.backend("numpy").run(library, name, inputs))


def test_reference_gets_the_exact_inputs_widened() -> None:
    seen: list[Any] = []
    inputs: dict[str, Any] = {
        "x": np.array([0.1], np.float32),
        "n": np.array([7], np.uint32),
        "s": {"y": np.array([0.2], np.float32), "z": np.array([[1, 2, 3]], np.float32)},
    }
    engine.expected_of(lambda *values: seen.extend(values), inputs)
    assert [v.dtype for v in seen[:2]] == [np.float64, np.uint32]
    assert seen[0][0] == float(np.float32(0.1))
    assert {k: v.dtype for k, v in seen[2].items()} == {"y": np.float64, "z": np.float64}
