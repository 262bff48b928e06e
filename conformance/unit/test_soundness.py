"""Enclosures hold exact values, tell what intervals miss, and what was recorded of them still passes.

Plan.
  enclosures  every operation's holds the value in 50 digits and is narrow; exact operations stay points
  functions   on a sample of functions, intervals under every table hold the enclosed value on every lane
  tightness   a row that promises too much is caught by the enclosures alone, operation by operation
  record      in what was recorded no interval missed a value, and every lane is accounted for
The whole sweep is `python -m conformance.soundness`; the nightly run does what is not recorded.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import TABLES, Table, load_table, permitted
from codegen.library import load_library
from codegen.ops import BUILTINS
from conformance import cases
from conformance.check.operations import LEANS_ON
from conformance.executor import Here, Job, Processes
from conformance.soundness import record
from conformance.soundness import sweep as sweeping
from conformance.soundness.__main__ import POINTS
from conformance.soundness.enclosure import Enclosure
from conformance.soundness.held import either_way, held, scalars
from conformance.soundness.jobs import BATCHES, missing, sweep_missing
from conformance.soundness.sweep import BATCH, different, sweep
from conformance.soundness.walk import enclosed, leaves
from conformance.unit.support.sources import library_of
from conformance.unit.support.tight import TOO_TIGHT, tightened

LIBRARY = load_library()
SEED = 20261123
FEW = 300
SAMPLE = ("sin_angle", "fakefur_shade", "hammersley", "safe_pow", "ggx_sample", "latlong_direction")
OPERATIONS = (
    "a + b",
    "a - b",
    "a * b",
    "(a + b) * (a + b)",
    "a * exp(b)",
    "a * (1.0 - exp(-80.0 * abs(b)))",
    "a / b",
    "(a + b) / (a * b)",
    "sqrt(abs(a + b))",
    "inverse_sqrt(abs(a) + 0.1)",
    "exp(a + b)",
    "exp2(a * b)",
    "log(abs(a) + abs(b))",
    "log2(abs(a * b) + 1.0)",
    "sin(a + b)",
    "cos(a * b)",
    "atan2(a, b)",
    "floor(a * 3.0) + b",
    "min(a + b, a * b) - max(a, b)",
    "clamp(a + b, -0.5, 0.5)",
    "length(vec3(a, b, a + b))",
    "dot(normalize(vec3(a, b, 1.0)), cross(vec3(a, b, 2.0), vec3(b, a, 1.0)))",
    "f32(i32(a * 5.0)) + b",
    "a + b if a < b else a * b",
)
NARROW = 1e-12
"""Width of an enclosure after a few operations, relative to 1 + |value|: 4500 float64 steps."""


@pytest.mark.parametrize("text", OPERATIONS)
def test_enclosure_holds_the_exact_value(text: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, f"def probe(a: X, b: X) -> f32:\n    return {text}\n")
    rng = np.random.default_rng(SEED)
    inputs = {name: rng.normal(0.0, 1.5, FEW).astype(np.float32) for name in "ab"}
    value, lost = enclosed(library, "probe", inputs)
    with mpmath.workdps(50):
        exact = evaluate(library, "probe", inputs, "mpmath")
        assert isinstance(value, Enclosure) and isinstance(exact, np.ndarray)
        for low, high, x in zip(value.low[~lost], value.high[~lost], exact[~lost], strict=True):
            assert mpmath.mpf(low) <= x <= mpmath.mpf(high)
            assert high - low <= NARROW * (1.0 + abs(x))
    assert lost.mean() < 0.02


def test_exact_operations_stay_points(tmp_path: Path) -> None:
    text = "vec4(a * b, a - 0.5, (a * 2.0) / 4.0, max(a, b) + 0.25)"
    library = library_of(tmp_path, f"def probe(a: X, b: X) -> vec4:\n    return {text}\n")
    value, lost = enclosed(library, "probe", {"a": [0.5, 3.0], "b": [0.1, -7.5]})
    assert not lost.any()
    for x in leaves(value):
        assert isinstance(x, Enclosure)
        assert np.array_equal(x.low, x.high)


def test_ends_of_24_bits_stay_exact(tmp_path: Path) -> None:
    """A little less than a number, as k (1 - exp(-x)) is, cannot pass for more than it."""
    text = "vec4(a * (1.0 - exp(b)), a * (exp(b) - 1.0), a + a * (1.0 - exp(b)), (a - a) * exp(b))"
    library = library_of(tmp_path, f"def probe(a: X, b: X) -> vec4:\n    return {text}\n")
    a = np.array([0.7, -0.7, 1e-30], np.float32)
    value, lost = enclosed(library, "probe", {"a": a, "b": np.full(3, -60.0)})
    assert not lost.any()
    less, more, twice, none = (x for x in leaves(value) if isinstance(x, Enclosure))
    k = a.astype(np.float64)
    assert np.array_equal(np.where(k > 0.0, less.high, less.low), k)
    assert np.array_equal(np.where(k > 0.0, more.low, more.high), -k)
    assert np.array_equal(np.where(k > 0.0, twice.high, twice.low), 2.0 * k)
    assert not none.low.any() and not none.high.any()


@pytest.mark.parametrize("name", SAMPLE)
def test_intervals_hold_the_exact_value(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweeping, "MOST_HARD", FEW // 10)
    monkeypatch.setattr(sweeping, "BATCH", FEW)
    found = sweep(LIBRARY, name, 0, 1)
    assert found.points == found.hard + FEW
    for table, count in found.tables.items():
        assert count.outside == 0, f"{table}: {found.worst}"
        assert count.undecided == 0, table
        assert count.enclosed > count.precise


@pytest.mark.parametrize("text", TOO_TIGHT)
def test_too_tight_a_row_is_caught(text: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, f"def probe(a: X) -> f32:\n    return {text}\n")
    inputs = {"a": np.linspace(0.1, 2.9, FEW).astype(np.float32)}
    value, lost = enclosed(library, "probe", inputs)

    def outside(table: Table) -> int:
        return int(held(permitted(library, "probe", inputs, table), value, lost).outside.sum())

    table = load_table("wgsl")
    assert outside(table) == 0
    assert outside(tightened(table, text)) > FEW // 2


@pytest.mark.parametrize(
    ("name", "count"), [("hammersley", 3), ("fakefur_shade", 3), ("octahedral_decode", 5)]
)
def test_tables_that_promise_the_same_are_swept_once(name: str, count: int) -> None:
    groups = different(LIBRARY, name)
    assert len(groups) == count
    assert sorted(table for _, names in groups.values() for table in names) == sorted(
        ["wgsl", "vulkan", "glsl", "glsl_es", "opencl", "opencl_relaxed"]
    )
    inputs = cases.draw(LIBRARY.function(name), cases.UNIFORM, 50, SEED)
    for first, names in groups.values():
        found = permitted(LIBRARY, name, inputs, first)
        for other in names[1:]:
            same = permitted(LIBRARY, name, inputs, either_way(load_table(other)))
            assert np.array_equal(found.codes, same.codes)
            for ends, others in ((found.low, same.low), (found.high, same.high)):
                for a, b in zip(scalars(ends), scalars(others), strict=True):
                    assert np.array_equal(a, b)


def test_inherited_promises_lean_on_what_their_formulas_name() -> None:
    """The functions of a formula, and division where it has a stroke."""
    for table in map(load_table, TABLES):
        for operation, row in table.rows.items():
            formula = getattr(row.accuracy, "formula", "")
            named = {op for op in BUILTINS if re.search(rf"\b{op}\(", formula)} | {"/"} & set(formula)
            assert named <= set(LEANS_ON.get(operation, ())), f"{table.name}: {operation} = {formula}"


def test_record_passes() -> None:
    entries = record.read()
    assert entries, "python -m conformance.soundness writes it"
    assert set(entries) <= set(LIBRARY.public), "functions that are gone"
    for entry in entries.values():
        assert record.passed(entry), f"{entry['function']}: {entry['worst']}"
        for count in entry["tables"].values():
            assert sum(count.values()) == entry["points"]


def test_sweeps_go_on_where_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweeping, "MOST_HARD", 5)
    monkeypatch.setattr(sweeping, "BATCH", FEW)
    name, entries = "sin_angle", dict[str, Any]()

    def jobs(points: int) -> list[Job]:
        return list(missing(LIBRARY, [name], entries, points))

    monkeypatch.setattr("conformance.soundness.jobs.BATCH", FEW)
    assert [(job.start, job.stop) for job in jobs(6 * FEW - 1)] == [(0, BATCHES), (BATCHES, 6)]
    results = list(sweep_missing(LIBRARY, Here(), jobs(2 * FEW), entries))
    assert [r.done for r in results] == [True]
    (job,) = jobs(3 * FEW)
    assert (job.start, job.stop) == (2, 3)
    later = replace(job, start=3, stop=4)
    assert len(list(sweep_missing(LIBRARY, Here(), [later], entries))) == 1
    assert entries[name]["batches"] == 2, "batch 2 is missing, so batch 3 is put aside"
    assert len(list(sweep_missing(LIBRARY, Here(), [job], entries))) == 1
    whole = sweep(LIBRARY, name, 0, 3).entry()
    assert {**entries[name], "seconds": 0.0} == {**whole, "seconds": 0.0}
    entries[name]["intervals"] = "changed"
    assert jobs(FEW)[0].start == 0


@pytest.mark.nightly
@pytest.mark.timeout(3 * 3600)
def test_intervals_hold_a_million_exact_values() -> None:
    """On two processes: what is not recorded of the present sources."""
    entries = record.read()
    jobs = list(missing(LIBRARY, list(LIBRARY.public), entries, POINTS))
    for result in sweep_missing(LIBRARY, Processes(2), jobs, entries):
        assert result.done, f"{result.job.identity}: {result.error}"
        assert record.passed(result.data), f"{result.job.function}: {result.data['worst']}"
    assert all(record.batches(LIBRARY, entries[name]) * BATCH >= POINTS for name in LIBRARY.public)
