"""What people and machines are told: console, JUnit, JSON under its schema.

Plan.
  console  a passing and a failing function in words that need no knowledge of the code; known failures and
           counts; a summary per backend
  JUnit    two cases per function, one for each verdict; known failures and missing guarantees are skips
  JSON     real results, good and bad, fit result.schema.json, and survive a round trip
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fastjsonschema
import numpy as np
import pytest
from junitparser import JUnitXml

from codegen.cli import run
from codegen.library import load_library
from conformance.check import engine
from conformance.check.draws import draws
from conformance.check.engine import check_function
from conformance.check.junit import junit_bytes
from conformance.check.report import lines, share
from conformance.check.result import FunctionResult
from conformance.mutation.fake_backend import fake_backend

SCHEMA = Path(engine.__file__).with_name("result.schema.json")
NAME = "sin_angle"


def checked(deviation: str, name: str = NAME) -> FunctionResult:
    library = load_library()
    return check_function(library, name, fake_backend(deviation), draws(library.function(name), 600, 60))


@pytest.fixture(scope="module")
def good() -> FunctionResult:
    return checked("faithful")


@pytest.fixture(scope="module")
def bad() -> FunctionResult:
    return checked("a thousand ULP off")


@pytest.fixture(scope="module")
def not_finite() -> FunctionResult:
    return checked("rare NaN")


def test_passing_function_is_told_verdict_by_verdict(good: FunctionResult) -> None:
    told = lines([good], details=True)
    assert told[:2] == [NAME, "  numpy: a fake: faithful"]
    text = "\n".join(told)
    assert f"permitted     yes: all {good.lanes} results are inside what the wgsl table permits" in text
    assert "within bound  yes: " in text
    assert "accuracy      relative (floor 0.00015): maximum " in text
    assert "worst input   a = (" in text
    assert f"finite        yes: all {good.lanes} results" in text
    summary = f"numpy of 1 function: permitted 1, within bound 1, finite 1; {good.lanes} inputs; "
    assert told[-1].startswith(summary)
    assert lines([good], details=False) == told[-1:]


def test_failing_function_is_told_with_inputs_and_replay(bad: FunctionResult) -> None:
    told = lines([bad], details=False)
    first = bad.failures[0]
    assert told[0].startswith(
        f"FAILED    {NAME} on a fake: a thousand ULP off: outside what wgsl permits and"
    )
    for word in ("inputs", "got", "reference", "exact", "permitted  NO", "bound      MISSED", "origin"):
        assert word in told[0]
    assert told[0].endswith(f"  replay     vair check --replay {first.identity}")
    assert len(bad.failures) == engine.MAX_FAILURES
    assert f'{bad.permitted and bad.permitted.outside} not "permitted"' in told[5]
    assert "permitted 0, within bound 0, finite 1" in told[-1]


def test_result_that_is_not_finite_is_told(not_finite: FunctionResult) -> None:
    text = "\n".join(lines([not_finite], details=True))
    assert f"finite        NO: {not_finite.non_finite} of {not_finite.lanes} results are not" in text
    assert "finite     NO: every finite input must give a finite result" in text


def test_known_failures_of_one_reason_are_one_line(bad: FunctionResult) -> None:
    other = checked("a thousand ULP off", "half_vector")
    for r in (bad, other):
        r.known = {"permitted": "a fault of the driver", "within bound": "the same"}
    told = lines([bad, other], details=False)
    for r in (bad, other):
        r.known = {}
    assert told[:-1] == [
        'known     not "permitted" on numpy: sin_angle, half_vector: a fault of the driver',
        'known     not "within bound" on numpy: sin_angle, half_vector: the same',
    ]
    assert "of 2 functions: permitted 0, within bound 0, finite 2 (2 with a known failure)" in told[-1]


def test_function_that_does_not_run_is_told() -> None:
    stopped = FunctionResult(
        NAME, "glsl", "a driver", "x+default", "compile", broken="does not compile: line 3"
    )
    told = lines([stopped], details=True)
    assert f"FAILED    {NAME} on x+default: does not compile: line 3" in told
    assert (stopped.failed, stopped.interval_verdict) == (("within bound",), "not judged")
    assert "permitted 0, within bound 0, finite 0" in told[-1]


@pytest.mark.parametrize(
    ("count", "of", "text"),
    [(0, 7, "0 %"), (7, 7, "100 %"), (1, 3, "33 %"), (1, 10**6, "0.0001 %"), (999_999, 10**6, "99.99 %")],
)
def test_share_is_whole_only_where_it_is(count: int, of: int, text: str) -> None:
    assert share(count, of) == text


def cases(*results: FunctionResult, missing: tuple[str, ...] = ()) -> dict[str, str]:
    """Name of each test case -> passed, failed or skipped with its text."""
    found = {}
    for suite in JUnitXml.fromstring(junit_bytes(results, missing)):
        for case in suite:
            told = [f"{type(r).__name__}: {r.message}" for r in case.result]
            found[f"{suite.name} {case.name}"] = told[0] if told else "passed"
    return found


def test_junit_has_a_case_for_each_verdict(good: FunctionResult, bad: FunctionResult) -> None:
    assert cases(good, missing=("glsl: no driver",)) == {
        "vair.numpy sin_angle [within bound]": "passed",
        "vair.numpy sin_angle [permitted]": "passed",
        "vair.glsl driver": "Skipped: glsl: no driver",
    }
    told = cases(bad)
    assert all(text.startswith(f"Failure: {NAME} on a fake") for text in told.values())
    assert len(told) == 2
    bad.known = {"permitted": "a fault of the driver"}
    told = cases(bad)
    bad.known = {}
    assert told["vair.numpy sin_angle [permitted]"] == "Skipped: known failure: a fault of the driver"
    assert told["vair.numpy sin_angle [within bound]"].startswith("Failure: ")


def test_junit_skips_what_no_table_bounds(good: FunctionResult) -> None:
    unjudged = FunctionResult.from_data(good.as_data())
    unjudged.permitted = None
    assert cases(unjudged)["vair.numpy sin_angle [permitted]"] == "Skipped: not judged"


@pytest.fixture(scope="module")
def validate() -> Callable[[Any], Any]:
    """Raises for data that is not as result.schema.json says."""
    compiled: Callable[[Any], Any] = fastjsonschema.compile(json.loads(SCHEMA.read_text(encoding="utf-8")))
    return compiled


def test_json_of_the_command_fits_its_schema(tmp_path: Path, validate: Callable[[Any], Any]) -> None:
    path = tmp_path / "result.json"
    assert run(["check", "--target", "numpy", "--function", "safe_sqrt", "--json", str(path)]) == 0
    data = json.loads(path.read_text(encoding="utf-8"), parse_constant=lambda text: pytest.fail(text))
    validate(data)
    assert data["results"][0]["verdicts"]["permitted"] == "permitted"
    with pytest.raises(fastjsonschema.JsonSchemaValueException):
        validate({**data, "colour": "red"})


@pytest.mark.parametrize("deviation", ["a thousand ULP off", "rare NaN", "rare infinity"])
@pytest.mark.parametrize("name", [NAME, "strand_angles"])
def test_json_of_failures_fits_its_schema(deviation: str, name: str, validate: Callable[[Any], Any]) -> None:
    result = checked(deviation, name)
    text = json.dumps(result.as_data(), allow_nan=False)
    whole = {"version": "1", "source": "0" * 16, "shard": "1/1", "skipped": [], "results": [json.loads(text)]}
    validate(whole)
    again = FunctionResult.from_data(json.loads(text))
    assert json.dumps(again.as_data(), allow_nan=False) == text
    assert (again.failed, again.accepted) == (result.failed, result.accepted)
    assert [f.lines() for f in again.failures] == [f.lines() for f in result.failures]


def test_record_of_a_vector_holds_both_ends(not_finite: FunctionResult) -> None:
    record = checked("sign lost", "half_vector").as_data()["failures"][0]
    assert len(record["low"]) == len(record["high"]) == 3
    assert np.all(np.array(record["low"]) <= np.array(record["high"]))
    assert not_finite.as_data()["failures"][0]["excess"] == "inf"
