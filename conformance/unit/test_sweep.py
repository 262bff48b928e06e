"""Sweeps: every number once, in pieces as in one, resumed where they stopped, honest about their kind."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.ir.types import F32
from codegen.library import load_library
from conformance.executor import Here, Job, Processes
from conformance.sweep import record
from conformance.sweep.plan import PIECE, critical, pieces
from conformance.sweep.positions import Positions, order_of, positions, sweepable
from conformance.sweep.state import State
from conformance.sweep.sweep import sweep
from conformance.sweep.task import CHUNK, TASK, run

LIBRARY = load_library()
SWEPT = sweepable(LIBRARY)
NAME = "safe_sqrt"
FEW = 3 * CHUNK // 2
"""Numbers of a sweep that spans two chunks."""


def test_every_function_of_one_number_is_swept() -> None:
    of_one = [
        name for name, f in LIBRARY.public.items() if len(f.parameters) == 1 and f.parameters[0].type == F32
    ]
    assert of_one
    assert set(of_one) <= set(SWEPT)


@pytest.mark.parametrize("name", SWEPT)
def test_places_are_the_numbers_of_the_domain_in_order(name: str) -> None:
    where = SWEPT[name]
    ends = np.concatenate([where.values(0, 5), where.values(where.count - 5, where.count + 9)])
    assert len(ends) == 10
    assert (np.diff(ends.astype(np.float64)) >= 0.0).all()
    domain = LIBRARY.function(name).parameters[0].domain
    if where.floats:
        assert float(ends[0]) >= domain.low and float(ends[-1]) <= domain.high  # type: ignore[union-attr]
        assert float(np.nextafter(ends[-1], np.float32(np.inf))) > domain.high  # type: ignore[union-attr]


def test_all_patterns_of_a_binade_occur_once() -> None:
    where = Positions(True, order_of(-1.0), order_of(1.0))
    assert where.count == 2 * 0x3F800001
    around = where.values(where.place(0.0) - 3, where.place(0.0) + 3)
    assert [f"{word:08x}" for word in around.view(np.uint32)] == [
        "80000002", "80000001", "80000000", "00000000", "00000001", "00000002",
    ]  # fmt: skip


def test_pieces_join_to_the_whole() -> None:
    whole = run(Job(TASK, NAME, "numpy", 0, FEW, 1))
    parts = [Job(TASK, NAME, "numpy", k, min(k + 300_000, FEW)) for k in range(0, FEW, 300_000)]
    joined = record.joined([(job, run(job)) for job in parts], FEW, "s")
    assert joined["kind"] == record.BOUND
    assert joined["numbers"] == whole["lanes"] == FEW
    assert [b["measured"] for b in joined["bounds"]] == [b["measured"] for b in whole["bounds"]]
    assert [b["lanes"] for b in joined["bounds"]] == [b["lanes"] for b in whole["bounds"]]
    less = record.joined([(job, run(job)) for job in parts[1:]], FEW, "s")
    assert less["kind"] == record.LOWER_BOUND


def test_pieces_cover_every_place_once() -> None:
    where = SWEPT[NAME]
    jobs = pieces(NAME, "numpy", where)
    assert [job.start for job in jobs] == list(range(0, where.count, PIECE))
    assert sum(job.stop - job.start for job in jobs) == where.count


def test_an_interrupted_sweep_goes_on(tmp_path: Path) -> None:
    where = {NAME: SWEPT[NAME]}
    jobs = [Job(TASK, NAME, "numpy", k * 1000, k * 1000 + 1000) for k in range(6)]
    path = tmp_path / "state.jsonl"

    class Interrupted:
        def run(self, jobs: Any) -> Any:
            yield from Here().run(list(jobs)[:4])
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep(LIBRARY, where, jobs, Interrupted(), State(path))
    with path.open("a", encoding="utf-8") as file:
        file.write('{"source": "cut o')
    done: list[Job] = []

    class Counting:
        def run(self, jobs: Any) -> Any:
            done.extend(jobs := list(jobs))
            return Here().run(jobs)

    resumed, failed = sweep(LIBRARY, where, jobs, Counting(), State(path))
    assert done == jobs[4:]
    assert not failed
    assert resumed == sweep(LIBRARY, where, jobs, Here())[0]


def test_processes_sweep_as_one_process_does() -> None:
    where = {NAME: SWEPT[NAME]}
    jobs = [Job(TASK, NAME, "numpy", k * 5000, k * 5000 + 5000) for k in range(4)]
    assert sweep(LIBRARY, where, jobs, Processes(2)) == sweep(LIBRARY, where, jobs, Here())


def test_a_miss_is_seen_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    from conformance.check.engine import Backend
    from conformance.sweep import task

    def off(library: Any, name: str, inputs: Any) -> Any:
        x = inputs["x"]
        got = np.sqrt(np.maximum(x, 0), dtype=np.float32)
        got[x.view(np.uint32) == 0x3F800007] *= np.float32(1.0 + 2e-6)
        got[x.view(np.uint32) == 0x3F800009] = np.nan
        return got

    monkeypatch.setitem(task._backends, "numpy", Backend("numpy", "bad", off))
    start = SWEPT[NAME].place(1.0)
    data = run(Job(TASK, NAME, "numpy", start - 100, start + 100))
    assert data["non_finite"] == 1
    assert data["not_finite"] == ["3f800009"]
    assert [b["failures"] for b in data["bounds"]] == [1]
    assert data["bounds"][0]["failed"] == ["3f800007"]
    assert data["bounds"][0]["worst"] == "3f800007"


def test_a_flushed_denormal_is_no_miss(monkeypatch: pytest.MonkeyPatch) -> None:
    from conformance.check.engine import Backend
    from conformance.sweep import task

    def flushing(library: Any, name: str, inputs: Any) -> Any:
        x = inputs["x"].astype(np.float64)
        return np.where(np.abs(x) < 2.0**-126, 0.0, -np.expm1(-x)).astype(np.float32)

    monkeypatch.setitem(task._backends, "numpy", Backend("numpy", "flushing", flushing))
    data = run(Job(TASK, "one_minus_exp_neg", "numpy", 0, 1000))
    assert data["denormal"] == 998
    assert not any(b["failures"] for b in data["bounds"])


def test_records_keep_the_widest_sweep(tmp_path: Path) -> None:
    entry = {"function": "f", "target": "opencl", "driver": "OpenCL 3.0; PoCL 3.1; cpu", "source": "s"}
    wide, narrow = {**entry, "numbers": 9}, {**entry, "numbers": 3}
    (path,) = record.keep([wide], tmp_path)
    assert path.name == "opencl-pocl-3.1.json"
    record.keep([narrow], tmp_path)
    assert record.read(path) == {"f": wide}
    record.keep([{**narrow, "source": "t"}], tmp_path)
    assert record.read(path)["f"]["numbers"] == 3


def test_critical_numbers_hold_ends_and_thresholds() -> None:
    where = positions(LIBRARY.function("bessel_i0e"))
    assert where is not None
    found = critical(LIBRARY, "bessel_i0e", where)
    assert {-1e5, 1e5, 0.0, 1.0} <= set(found)
