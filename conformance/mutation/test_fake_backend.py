"""A backend that is wrong on purpose is judged exactly as planned, under both verdicts of `vair check`.

Plan. Each deviation of deviations.toml on each of its functions; and the deviations themselves, so that none
is right by accident.

Not covered here: what devices really do (conformance/execute).
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest

from codegen.library import load_library
from conformance.check import engine
from conformance.check.draws import draws
from conformance.check.interval import PERMITTED
from conformance.check.prepared import Prepared, prepare
from conformance.mutation.fake_backend import AFTER, DEVIATIONS, RARE, WITHIN, fake_backend, ulps
from conformance.mutation.plan import read

UNIFORM, FAMILY = 1500, 150
PLANNED: list[dict[str, Any]] = read("deviations.toml")["deviation"]
CASES = list(dict.fromkeys((entry["name"], function) for entry in PLANNED for function in entry["functions"]))
JUDGES = ("bounds", "intervals")
ON_A_PROBE = {"poor sine", "sine worse than permitted"}
"""Deviations of an operation that the library avoids: tried on one line in unit/test_check_interval.py."""


@functools.cache
def prepared(name: str) -> Prepared:
    """Inputs, references and intervals of a function, for all deviations."""
    library = load_library()
    return prepare(library, name, draws(library.function(name), UNIFORM, FAMILY))


@pytest.mark.parametrize(("deviation", "name"), CASES)
def test_verdicts_are_as_planned(deviation: str, name: str) -> None:
    result = engine.check_function(load_library(), name, fake_backend(deviation), prepared=prepared(name))
    found = {
        "bounds": result.within and not result.non_finite,
        "intervals": result.interval_verdict == PERMITTED,
    }
    planned = [e for e in PLANNED if e["name"] == deviation and name in e["functions"]]
    for entry in planned:
        for judge in JUDGES:
            if judge in entry:
                assert found[judge] == (entry[judge] == "pass"), entry["why"]
    assert bool(result.failures) == (not result.passed)


def test_every_deviation_has_a_planned_verdict() -> None:
    assert {entry["name"] for entry in PLANNED} | ON_A_PROBE == set(DEVIATIONS)
    assert all(set(JUDGES) & set(entry) and entry["why"] for entry in PLANNED)
    assert {entry.get(judge, "pass") for entry in PLANNED for judge in JUDGES} == {
        "pass",
        "fail",
    }


def test_deviations_do_what_they_say() -> None:
    """A backend that was right by accident would prove nothing."""
    a = np.array([1.0, -1.0, 0.0, 0.0, 1e-40, 3.0, 4.0, 5.0], np.float32)
    assert ulps(1, a)[:3].tolist() == [1.0 + 2.0**-23, -1.0 - 2.0**-23, 0.0]
    assert AFTER["denormals flushed"](a)[4] == 0.0
    assert np.signbit(AFTER["signs of zero exchanged"](a)[2])
    assert AFTER["last chunk lost"](a).tolist() == [*a[:7].tolist(), 0.0]
    assert AFTER["one lane late"](a)[1] == a[0]
    assert np.isnan(AFTER["rare NaN"](np.ones(RARE, np.float32))).sum() == 1


@pytest.mark.parametrize("entry", [e for e in PLANNED if e["name"] in WITHIN], ids=lambda e: e["name"])
def test_deviating_operations_reach_the_result(entry: dict[str, Any]) -> None:
    library = load_library()
    for name in entry["functions"]:
        inputs = prepared(name).sample.inputs
        faithful, got = (fake_backend(d).run(library, name, inputs) for d in ("faithful", entry["name"]))
        assert not np.array_equal(faithful, got)
        assert np.array_equal(faithful, engine.backend("numpy").run(library, name, inputs))


def test_unknown_deviation_is_an_error() -> None:
    with pytest.raises(KeyError):
        fake_backend("clairvoyant")
