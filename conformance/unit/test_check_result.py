"""Results as data: what accepts a failure, what nothing counts from, and what comes back from JSON.

Plan. Results are made by hand, so that every field has a value of its own.
  accepted   a known failure excuses its own verdict and no other
  beginning  counts start at zero
  data       what `as_data` writes, through JSON, is what `from_data` reads, the program among it
"""

from __future__ import annotations

import dataclasses
import json
from typing import Any

import numpy as np
import pytest

from codegen.library import load_library
from conformance.check.accuracy import Accuracy
from conformance.check.engine import Backend, check_function, draw
from conformance.check.failure import FINITE, PERMITTED, WITHIN
from conformance.check.interval import IntervalResult
from conformance.check.result import BoundResult, FunctionResult

INF = float("inf")


def result(**fields: Any) -> FunctionResult:
    return FunctionResult("f", "glsl", "a driver", **fields)


def outside() -> IntervalResult:
    return IntervalResult("glsl", lanes=9, inside=8, outside=1)


@pytest.mark.parametrize(
    ("known", "accepted"),
    [
        ({}, False),
        ({WITHIN: "why"}, False),
        ({PERMITTED: "why"}, False),
        ({FINITE: "why"}, False),
        ({WITHIN: "why", PERMITTED: "why"}, True),
    ],
    ids=str,
)
def test_a_known_failure_excuses_its_own_verdict(known: dict[str, str], accepted: bool) -> None:
    bad = result(bounds=[BoundResult("b", 0.5, failures=1)], permitted=outside(), known=known)
    assert bad.failed == (PERMITTED, WITHIN)
    assert not bad.passed
    assert bad.accepted == accepted


def test_what_is_known_need_not_happen() -> None:
    assert result(known={WITHIN: "why"}).accepted


def test_counts_start_at_zero() -> None:
    assert BoundResult("b", 0.5) == BoundResult("b", 0.5, 0.0, 0.0, 0.0, "", 0, 0)
    assert result().passed
    assert result().accepted
    fresh = result()
    counts = fresh.lanes, fresh.non_finite, fresh.ambiguous, fresh.uncovered, fresh.seconds
    assert counts == (0, 0, 0, 0, 0.0)


@pytest.mark.parametrize("error", [0.0, 4.0])
def test_results_come_back_from_json(error: float) -> None:
    library = load_library()
    on = Backend(
        "numpy",
        "d",
        lambda library, name, inputs: np.float32(error) + np.sqrt(np.maximum(inputs["x"], 0)),
        text=lambda library, name: "the program",
    )
    function = library.function("safe_sqrt")
    found = check_function(library, "safe_sqrt", on, [draw(function, "uniform", 40, 3)])
    found.seconds = 1.23456
    again = FunctionResult.from_data(json.loads(json.dumps(found.as_data())))
    assert (found.program, again.program) == (("the program",) * 2 if error else ("", ""))
    assert again.seconds == 1.235
    found.seconds = again.seconds
    assert again == found
    assert again.as_data() == found.as_data()


def test_every_field_comes_back_from_json() -> None:
    """A field that is forgotten comes back as its default, so none has its default here."""
    found = result(
        backend="a backend",
        stage="execute",
        known={WITHIN: "why"},
        lanes=70,
        non_finite=1,
        ambiguous=2,
        uncovered=3,
        seconds=1.5,
        bounds=[BoundResult("b", 0.5, 0.25, 0.125, 0.0625, "an input", 9, 1)],
        permitted=IntervalResult("glsl", lanes=9, inside=7, outside=1, rearranged=1, excess=2.5),
        accuracy=[Accuracy("ULP", 0.5, 8, 4.0, 3.0, 2.0, "an input")],
        broken="it stopped",
        source="a hash",
        emitted="another hash",
    )
    with_failures = {"failures", "program"}
    for field in dataclasses.fields(found):
        default = field.default_factory() if callable(field.default_factory) else field.default
        assert field.name in with_failures or getattr(found, field.name) != default, field.name
    data = json.loads(json.dumps(found.as_data()))
    again = FunctionResult.from_data(data)
    for field in dataclasses.fields(found):
        assert getattr(again, field.name) == getattr(found, field.name), field.name


def test_infinite_figures_come_back_as_numbers() -> None:
    found = result(
        bounds=[BoundResult("b", 0.5, INF, INF, INF)],
        permitted=IntervalResult("glsl", excess=INF),
        accuracy=[Accuracy("ULP", 0.5, 8, INF, INF, INF, "an input")],
    )
    again = FunctionResult.from_data(json.loads(json.dumps(found.as_data(), allow_nan=False)))
    assert (again.bounds, again.permitted, again.accuracy) == (found.bounds, found.permitted, found.accuracy)
