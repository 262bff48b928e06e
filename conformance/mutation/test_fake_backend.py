"""A backend that is wrong on purpose is judged exactly as planned, by bounds and by intervals.

Plan. Each deviation of deviations.toml on each of its functions; a poor sine on one line of source; and the
deviations themselves, so that none is right by accident.

Not covered here: what devices really do (conformance/execute).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.bounds import Bound
from codegen.intervals import permitted
from codegen.library import Library, load_library
from conformance.check import engine, measure
from conformance.check.engine import Draw
from conformance.mutation.fake_backend import AFTER, DEVIATIONS, RARE, SINE_ERROR, WITHIN, fake_backend, ulps
from conformance.mutation.plan import read
from conformance.unit.support.sources import library_of

TABLE = "wgsl"
UNIFORM, FAMILY = 1500, 150
PLANNED: list[dict[str, Any]] = read("deviations.toml")["deviation"]
CASES = [
    (entry["name"], function, judge, entry[judge])
    for entry in PLANNED
    for function in entry["functions"]
    for judge in ("bounds", "intervals")
    if judge in entry
]
ON_A_PROBE = {"poor sine", "sine worse than permitted"}
"""Deviations of an operation that the library avoids: tried on a function of one line."""


def drawn(name: str) -> list[Draw]:
    return list(engine.draws(load_library().function(name), UNIFORM, FAMILY))


def permitted_everywhere(library: Library, name: str, deviation: str, draws: list[Draw]) -> bool:
    on = fake_backend(deviation)
    return all(
        permitted(library, name, d.inputs, TABLE).contains(on.run(library, name, d.inputs)).all()
        for d in draws
    )


@pytest.mark.parametrize(("deviation", "name", "judge", "verdict"), CASES)
def test_verdict_is_as_planned(deviation: str, name: str, judge: str, verdict: str) -> None:
    library = load_library()
    if judge == "bounds":
        passed = engine.check_function(library, name, fake_backend(deviation), drawn(name)).passed
    else:
        passed = permitted_everywhere(library, name, deviation, drawn(name))
    assert passed == (verdict == "pass")


@pytest.mark.parametrize(
    ("deviation", "is_permitted"),
    [("faithful", True), ("poor sine", True), ("sine worse than permitted", False)],
)
def test_poor_sine_is_permitted_and_yet_visible(deviation: str, is_permitted: bool, tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X) -> f32:\n    return sin(x)\n")
    inputs = {"x": np.linspace(-3.0, 3.0, 2001, dtype=np.float32)}
    assert permitted_everywhere(library, "probe", deviation, [Draw("here", 2001, 0, inputs)]) == is_permitted
    got = fake_backend(deviation).run(library, "probe", inputs)
    bound = Bound("probe", "absolute", 0.0, "here", "this test")
    error = float(measure.error(bound, got, np.sin(inputs["x"].astype(np.float64))).max())
    assert (error > 0.9 * SINE_ERROR) == (deviation != "faithful")


def test_every_deviation_has_a_planned_verdict() -> None:
    assert {entry["name"] for entry in PLANNED} | ON_A_PROBE == set(DEVIATIONS)
    assert all({"bounds", "intervals"} & set(entry) and entry["why"] for entry in PLANNED)
    assert {entry.get(judge, "pass") for entry in PLANNED for judge in ("bounds", "intervals")} == {
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
        inputs = drawn(name)[0].inputs
        faithful, got = (fake_backend(d).run(library, name, inputs) for d in ("faithful", entry["name"]))
        assert not np.array_equal(faithful, got)
        assert np.array_equal(faithful, engine.backend("numpy").run(library, name, inputs))


def test_unknown_deviation_is_an_error() -> None:
    with pytest.raises(KeyError):
        fake_backend("clairvoyant")
