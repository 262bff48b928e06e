"""The verdict "permitted": each result against the interval that an accuracy table allows.

Plan. Functions of one line whose intervals are known, on a backend that returns given numbers.
  counted      inside, outside, unguaranteed and rearranged results, each exactly once
  unguaranteed counts for nothing: neither a pass nor a failure; a function without any guarantee says so
  two verdicts either may be bad alone; a NaN is bad under both; one record per lane holds all of them
  how far      half widths from the middle of the interval, of the worst component
  deviations   k ULP off, another order of sums, flushed, other signs of zero, NaN: each on one line of source
  a poor sine  is permitted by WGSL, not by OpenCL, and visible in the accuracy beside it
Not covered here: the intervals themselves (test_intervals_*.py), library functions (test_fake_backend.py).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.intervals import permitted
from conformance.check import interval, prepared
from conformance.check.backend import Backend
from conformance.check.draws import Draw
from conformance.check.engine import check_function
from conformance.check.failure import FINITE, PERMITTED, WITHIN
from conformance.check.interval import OUTSIDE, UNGUARANTEED, IntervalResult
from conformance.check.report import interval_text
from conformance.check.result import FunctionResult
from conformance.mutation.fake_backend import SINE_ERROR, fake_backend
from conformance.unit.support.sources import library_of
from conformance.unit.support.tolerances import tolerance

INF, NAN = np.inf, np.nan
LOOSE = '[[probe]]\nmeasure = "absolute"\nbound = 1e30\ndomain = "all"\norigin = "derived"\n'
IDENTITY = "def probe(x: X) -> f32:\n    return x\n"
PRODUCT = "def probe(x: X) -> f32:\n    return 3.0 * x\n"
QUOTIENT = "def probe(x: X) -> f32:\n    return 1.0 / x\n"
SUM = "def probe(x: X, y: X) -> f32:\n    return (x + y) + 0.1\n"
DOT = "def probe(v: V) -> f32:\n    return dot(v, vec3(1.0, 1.0, 1.0))\n"
SINE = "def probe(x: X) -> f32:\n    return sin(x)\n"
X = np.float32(1.1)
LOW, HIGH = 3.2999999523162842, 3.3000001907348633
"""The float32 numbers around 3 X, either of which WGSL permits."""
STEP = HIGH - LOW
ZEROS = {"w": (0, 1), "x": (2, 3, 4, 5), "y": (6,), "z": (7, 8, 9)}
"""Lanes in which a parameter is 0."""

Judge = Callable[..., FunctionResult]


@pytest.fixture
def judge(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Judge:
    """judge(source, inputs, results, target=, bound=, expected=, table=): one draw of these."""

    def run(
        source: str,
        inputs: dict[str, list[Any]],
        results: list[Any],
        target: str = "wgsl",
        bound: float = 1e30,
        expected: Callable[..., Any] | None = None,
        table: str = "",
    ) -> FunctionResult:
        library = library_of(tmp_path, source)
        (tmp_path / "numeric/bounds.toml").write_text(LOOSE.replace("1e30", repr(bound)), encoding="utf-8")
        got = np.array(results, np.float32)
        wanted = expected or (lambda *_: got.astype(np.float64))
        monkeypatch.setattr(prepared, "find_reference", lambda *_: wanted)
        given = {name: np.array(values, np.float32) for name, values in inputs.items()}
        on = Backend(target, "a driver", lambda *_: got, table=table)
        return check_function(library, "probe", on, [Draw("here", len(got), 7, given)])

    return run


def counts(r: FunctionResult) -> tuple[int, int, int, int, int]:
    assert r.permitted is not None
    p = r.permitted
    return p.lanes, p.inside, p.rearranged, p.outside, p.unguaranteed


def test_nothing_is_counted_beforehand() -> None:
    assert IntervalResult("wgsl") == IntervalResult("wgsl", 0, 0, 0, 0, 0, 0.0, "", {})


@pytest.mark.parametrize(
    ("lanes", "unguaranteed", "share"), [(0, 0, 0.0), (0, 1, 1.0), (1, 0, 0.0), (3, 1, 0.25)]
)
def test_share_of_unguaranteed_results(lanes: int, unguaranteed: int, share: float) -> None:
    assert IntervalResult("wgsl", lanes=lanes, unguaranteed=unguaranteed).unguaranteed_share == share


def test_results_inside_and_outside_are_counted(judge: Judge) -> None:
    result = judge(IDENTITY, {"x": [1, 2, 3, 4]}, [1, 2, 3.5, 5])
    assert counts(result) == (4, 2, 0, 2, 0)
    assert result.interval_verdict == OUTSIDE
    assert (result.failed, result.passed, result.within) == ((PERMITTED,), False, True)
    assert {f.identity.lane for f in result.failures} == {2, 3}
    assert result.permitted is not None
    assert (result.permitted.table, result.permitted.excess) == ("wgsl", INF)
    good = judge(IDENTITY, {"x": [1, 2]}, [1, 2])
    assert (good.interval_verdict, good.passed, good.failures) == (PERMITTED, True, [])


def test_unguaranteed_results_count_for_nothing(judge: Judge) -> None:
    result = judge(QUOTIENT, {"x": [0, 2, 0, 4]}, [77, 0.5, -3, 0.25])
    assert counts(result) == (2, 2, 0, 0, 2)
    assert (result.interval_verdict, result.passed) == (PERMITTED, True)
    assert result.permitted is not None
    assert result.permitted.unguaranteed_share == 0.5
    assert "the divisor may be 0" in next(iter(result.permitted.causes))
    bad = judge(QUOTIENT, {"x": [0, 2]}, [77, 0.75])
    assert counts(bad) == (1, 0, 0, 1, 1)
    assert bad.failed == (PERMITTED,)


def test_most_frequent_causes_are_told(judge: Judge) -> None:
    lines = "".join(f"    of_{name} = 1.0 / {name}\n" for name in ZEROS)
    source = f"def probe(w: X, x: X, y: X, z: X) -> f32:\n{lines}    return of_w + of_x + of_y + of_z\n"
    zero = {name: [0.0 if k in lanes else 1.0 for k in range(10)] for name, lanes in ZEROS.items()}
    result = judge(source, zero, [4.0] * 10)
    assert result.permitted is not None
    told = [(cause.partition(" of ")[0], count) for cause, count in result.permitted.causes.items()]
    assert told == [("line 4", 4), ("line 6", 3), ("line 3", 2)]


@pytest.mark.parametrize("got", [NAN, INF, -INF])
def test_what_is_no_number_lies_outside_even_around_zero(judge: Judge, got: float) -> None:
    result = judge(IDENTITY, {"x": [0.0]}, [got], expected=lambda x: np.zeros(1))
    assert result.failed == (FINITE, PERMITTED)
    assert counts(result) == (1, 0, 0, 1, 0)


def test_function_without_any_guarantee_is_not_permitted(judge: Judge) -> None:
    result = judge(QUOTIENT, {"x": [0, 0]}, [1, 2])
    assert (result.interval_verdict, result.failed) == (UNGUARANTEED, ())
    assert interval_text(result).startswith("UNGUARANTEED")
    assert result.as_data()["verdicts"] == {FINITE: True, PERMITTED: "unguaranteed", WITHIN: True}


def test_unguaranteed_results_must_be_finite_all_the_same(judge: Judge) -> None:
    result = judge(QUOTIENT, {"x": [0]}, [NAN], expected=lambda x: np.zeros(1))
    assert result.failed == (FINITE,)
    assert result.failures[0].interval.startswith("anything (line 3 of probe: / of y")


def test_product_lies_between_its_neighbours() -> None:
    assert LOW < 3.0 * float(X) < HIGH
    assert np.nextafter(np.float32(LOW), np.float32(4.0)) == np.float32(HIGH)


@pytest.mark.parametrize(
    ("got", "bound", "failed"),
    [
        (LOW, 0.5, ()),
        (HIGH, 0.5, ()),
        (HIGH + STEP, 0.5, (PERMITTED,)),
        (LOW, 1e-9, (WITHIN,)),
        (4.0, 0.5, (PERMITTED, WITHIN)),
        (NAN, 0.5, (FINITE, PERMITTED)),
        (INF, 0.5, (FINITE, PERMITTED)),
    ],
)
def test_either_verdict_may_be_bad_alone(
    judge: Judge, got: float, bound: float, failed: tuple[str, ...]
) -> None:
    result = judge(PRODUCT, {"x": [X]}, [got], bound=bound, expected=lambda x: np.array([3.3001]))
    assert result.failed == failed
    assert [f.failed for f in result.failures] == ([failed] if failed else [])
    for failure in result.failures:
        told = "\n".join(failure.lines())
        answer = "NO" if PERMITTED in failed else "yes"
        assert f"permitted  {answer}: wgsl permits 3.29999995 to 3.30000019" in told
        assert ("MISSED" in told) == (WITHIN in failed)
        assert float(failure.exact) == pytest.approx(3.0 * float(X), rel=tolerance("rounded"))
        assert (failure.low, failure.high) == (LOW, HIGH)


def test_what_misses_a_bound_comes_before_what_is_only_outside(judge: Judge) -> None:
    """By however little, also where the bound is 0."""
    result = judge(PRODUCT, {"x": [X, X]}, [4.0, LOW], bound=0.0, expected=lambda x: np.array([4.0, HIGH]))
    assert [(f.identity.lane, f.failed) for f in result.failures] == [(1, (WITHIN,)), (0, (PERMITTED,))]


def test_half_widths_from_the_middle(judge: Judge) -> None:
    result = judge(PRODUCT, {"x": [X, X, X]}, [LOW, HIGH + STEP, LOW - 2 * STEP])
    assert result.permitted is not None
    assert result.permitted.excess == pytest.approx(5.0, rel=tolerance("rounded"))
    assert [f.excess for f in result.failures] == pytest.approx([5.0, 3.0], rel=tolerance("rounded"))
    assert [f.identity.lane for f in result.failures] == [2, 1]
    assert result.permitted.worst.startswith("x = 1.1")


@pytest.mark.parametrize(
    ("low", "high", "got", "far"),
    [
        ([0.0], [2.0], [1.0], 0.0),
        ([0.0], [2.0], [2.0], 1.0),
        ([0.0], [2.0], [-0.5], 1.5),
        ([1.0], [1.0], [1.0], 0.0),
        ([1.0], [1.0], [2.0], INF),
        ([1.0], [2.0], [NAN], INF),
        ([-INF], [INF], [5.0], 0.0),
        ([[0.0, 0.0]], [[2.0, 4.0]], [[1.0, 6.0]], 2.0),
    ],
)
def test_how_far_a_result_is_out(low: Any, high: Any, got: Any, far: float) -> None:
    assert interval.excess(np.array(low), np.array(high), np.array(got, np.float32)).tolist() == [far]


def test_worst_field_of_a_struct_counts() -> None:
    low, high = {"a": np.array([0.0]), "b": np.array([0.0])}, {"a": np.array([2.0]), "b": np.array([2.0])}
    got = {"a": np.array([4.0], np.float32), "b": np.array([1.0], np.float32)}
    assert interval.excess(low, high, got).tolist() == [3.0]
    with pytest.raises(ValueError):
        interval.excess(low, high, {"a": got["a"]})


def test_result_inside_is_out_by_its_whole_interval_at_most() -> None:
    """Even where half the width is no number above 0."""
    ends = np.zeros(1), np.full(1, 5e-324)
    assert all(interval.excess(*ends, x) <= 1.0 for x in ends)


@pytest.mark.parametrize(
    ("target", "table", "allowed"),
    [
        ("glsl", "", True),
        ("opencl", "", False),
        ("opencl", "opencl_relaxed", True),
        ("glsl", "opencl", False),
        ("numpy", "", False),
    ],
)
def test_rearrangement_is_told_where_it_is_allowed(
    judge: Judge, target: str, table: str, allowed: bool
) -> None:
    """By the table that judges. The evaluator is judged by WGSL's, yet rearranges nothing itself.

    Beside it a result that needs no rearrangement.
    """
    x, y, tenth = np.float32(1e8), np.float32(-1e8), np.float32(0.1)
    written, other = (np.float32(1.0) + np.float32(2.0)) + tenth, (x + tenth) + y
    result = judge(SUM, {"x": [1.0, x], "y": [2.0, y]}, [written, other], target, table=table)
    assert counts(result) == ((2, 1, 1, 0, 0) if allowed else (2, 1, 0, 1, 0))
    assert ("after a rearrangement" in interval_text(result)) == allowed


@pytest.mark.parametrize(
    ("source", "inputs", "got", "good"),
    [
        (PRODUCT, {"x": [X]}, [LOW], True),
        (PRODUCT, {"x": [X]}, [HIGH], True),
        (PRODUCT, {"x": [X]}, [HIGH + STEP], False),
        (DOT, {"v": [[1e8, 1.0, -1e8]]}, [0.0], True),
        (DOT, {"v": [[1e8, 1.0, -1e8]]}, [1.0], True),
        (DOT, {"v": [[1e8, 1.0, -1e8]]}, [40.0], False),
        (IDENTITY, {"x": [1e-40]}, [0.0], True),
        (IDENTITY, {"x": [2e-38]}, [0.0], False),
        (IDENTITY, {"x": [0.0]}, [-0.0], True),
    ],
    ids=[
        "lower neighbour", "upper neighbour", "one ULP further", "sum from the left", "sum from the ends",
        "no sum", "flushed", "flushed though normal", "sign of zero",
    ],
)  # fmt: skip
def test_deviations_of_one_operation(
    judge: Judge, source: str, inputs: dict[str, list[Any]], got: list[float], good: bool
) -> None:
    assert (judge(source, inputs, got).interval_verdict == PERMITTED) == good


@pytest.mark.parametrize(
    ("deviation", "target", "verdict"),
    [
        ("faithful", "wgsl", PERMITTED),
        ("poor sine", "wgsl", PERMITTED),
        ("poor sine", "opencl", OUTSIDE),
        ("sine worse than permitted", "wgsl", OUTSIDE),
    ],
)
def test_poor_sine_is_permitted_by_wgsl_and_visible(
    judge: Judge, tmp_path: Path, deviation: str, target: str, verdict: str
) -> None:
    x = np.linspace(-3.0, 3.0, 2001, dtype=np.float32)
    got = fake_backend(deviation).run(library_of(tmp_path, SINE), "probe", {"x": x})
    result = judge(SINE, {"x": x.tolist()}, got.tolist(), target, expected=np.sin)
    assert result.interval_verdict == verdict
    (told,) = result.accuracy
    assert told.measure == "ULP"
    # The error as ULP of numbers just below 1, of which there are 2^24.
    assert (told.maximum > 0.9 * SINE_ERROR * 2.0**24) == (deviation != "faithful")
    assert told.median <= told.p999 <= told.maximum


def test_intervals_are_those_of_the_table(judge: Judge, tmp_path: Path) -> None:
    """What the verdict counts is what the intervals say, lane by lane."""
    x = np.linspace(-3.0, 3.0, 501, dtype=np.float32)
    got = (np.sin(x.astype(np.float64)) + np.linspace(0.0, 1e-3, 501)).astype(np.float32)
    allowed = permitted(library_of(tmp_path, SINE), "probe", {"x": x}, "wgsl")
    result = judge(SINE, {"x": x.tolist()}, got.tolist())
    assert counts(result)[1] == int(allowed.contains(got).sum())
    assert 0 < counts(result)[1] < 501
