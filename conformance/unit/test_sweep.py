"""Sweeps: every number once, in pieces as in one, resumed where they stopped, honest about their kind."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.ir.types import F32
from codegen.kernels import kernel
from codegen.library import load_library
from conformance.check import engine
from conformance.check.engine import Backend
from conformance.executor import Here, Job, Processes, Result
from conformance.executor.state import State
from conformance.sweep import judge, record, task
from conformance.sweep.plan import PIECE, critical, pieces
from conformance.sweep.positions import Positions, order_of, positions, sweepable
from conformance.sweep.source import hash_of, source_of
from conformance.sweep.sweep import sweep
from conformance.sweep.task import BLOCK, CHUNK, TASK, TOGETHER, run, run_together

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
    assert [(job.task, job.start) for job in done] == [(TOGETHER, job.start) for job in jobs[4:]]
    assert not failed
    assert resumed == sweep(LIBRARY, where, jobs, Here())[0]
    done.clear()
    again, _ = sweep(LIBRARY, where, jobs, Counting(), State(path))
    assert again == resumed
    assert not done, "a piece done after the line that was cut short is remembered"


def counted(monkeypatch: pytest.MonkeyPatch, where: Any, name: str) -> list[Any]:
    """The calls of a function from now on."""
    calls: list[Any] = []
    function = getattr(where, name)

    def counting(*given: Any) -> Any:
        calls.append(given)
        return function(*given)

    monkeypatch.setattr(where, name, counting)
    return calls


def wrong_here_and_there(library: Any, name: str, inputs: Any) -> Any:
    """What the evaluator gives, with errors, infinities and NaN planted at places that the inputs choose."""
    x = next(iter(inputs.values()))
    got = np.array(evaluate(library, name, inputs))
    mark = x.view(np.uint32) * np.uint32(2654435761) >> np.uint32(16)
    if got.dtype.kind == "f":
        for number, wrong in ((1, np.nan), (2, np.inf), (3, 1e3)):
            got[mark == number] = wrong
        got[mark % 1024 == 5] *= np.float32(1.0 + 3e-7)
    else:
        got[mark == 7] ^= 1
    return got


@pytest.mark.parametrize("name", ["safe_sqrt", "one_minus_exp_neg_rational", "log_one_minus", "unit_float"])
def test_a_closer_look_finds_nothing_else(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks that are counted without one are those in which it would have found nothing."""
    monkeypatch.setitem(task._backends, "numpy", Backend("numpy", "bad", wrong_here_and_there))
    where = SWEPT[name]
    seen = []
    for start in (where.count // 2, where.count - 20 * BLOCK, max(where.place(0.5) - 5 * BLOCK, 0)):
        job = Job(TASK, name, "numpy", start, start + 20 * BLOCK)
        quick = run(job)
        with monkeypatch.context() as patch:
            patch.setattr(judge.Judge, "_nothing_new", lambda self, block, got: False)
            assert run(job) == quick
        seen.append(quick)
    assert sum(data["bounds"][0]["failures"] for data in seen) > 0
    assert sum(data["non_finite"] for data in seen) > 0


def test_most_blocks_need_no_closer_look(monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at = counted(monkeypatch, judge.Judge, "_look")
    start = SWEPT[NAME].place(1.0)
    run(Job(TASK, NAME, "numpy", start, start + 100 * BLOCK))
    assert 0 < len(looked_at) < 20


def test_targets_swept_together_share_the_reference(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(task._backends, "first", Backend("first", "one driver", evaluate))
    monkeypatch.setitem(task._backends, "second", Backend("second", "another", wrong_here_and_there))
    start = SWEPT[NAME].place(1.0)
    jobs = [Job(TASK, NAME, target, start, start + 4 * BLOCK) for target in ("first", "second")]
    alone = [run(job) for job in jobs]
    assert alone[0]["bounds"] != alone[1]["bounds"]
    asked = counted(monkeypatch, engine, "expected_of")
    both = run_together(Job(TOGETHER, NAME, "first,second", start, start + 4 * BLOCK))
    assert list(both.values()) == alone
    assert len(asked) == 4


def test_a_piece_is_swept_for_those_targets_that_lack_it(tmp_path: Path) -> None:
    where = {NAME: SWEPT[NAME]}
    jobs = [Job(TASK, NAME, target, k, k + 9) for target in ("a", "b") for k in (0, 9)]
    source = source_of(LIBRARY, NAME, "a")
    given: list[Job] = []

    class Told:
        def run(self, jobs: Any) -> Any:
            for job in jobs:
                given.append(job)
                counts = {"lanes": 9, "denormal": 0, "non_finite": 0, "not_finite": [], "bounds": []}
                one = {"driver": "d", "source": source, **counts}
                failed = "no" if (job.start, job.target) == (0, "a,b") else ""
                yield Result(job, {} if failed else {target: one for target in job.targets}, failed)

    state = State(tmp_path / "state.jsonl")
    sweep(LIBRARY, where, jobs[1:2], Told(), state)
    entries, failed = sweep(LIBRARY, where, jobs, Told(), state)
    assert [(job.start, job.target) for job in given] == [(9, "a"), (0, "a,b"), (9, "b")]
    assert failed == {jobs[0]: "no", jobs[2]: "no"}
    assert [(e["target"], e["numbers"]) for e in entries] == [("a", 9), ("b", 9)]


def test_a_piece_of_other_sources_does_not_count(tmp_path: Path) -> None:
    where, state = {NAME: SWEPT[NAME]}, tmp_path / "state.jsonl"
    jobs = [Job(TASK, NAME, "numpy", 0, 9)]

    class Changed:
        def run(self, jobs: Any) -> Any:
            for result in Here().run(jobs):
                result.data["numpy"]["source"] = "of tomorrow"
                yield result

    entries, failed = sweep(LIBRARY, where, jobs, Changed(), State(state))
    assert not entries and not state.exists()
    assert failed == {jobs[0]: "its source changed while it was swept"}


def test_comments_are_no_part_of_a_source() -> None:
    program = kernel(LIBRARY, NAME, "glsl")
    assert hash_of(f"// a word\n\n{program}\n   // another\n") == hash_of(program)
    assert hash_of(f"#ifndef A_1F\n#define A_1F\n{program}\n#endif\n") == hash_of(program)
    assert hash_of(f"#define A 1\n{program}") != hash_of(program)
    assert hash_of(program.replace("0.0", "1.0")) != hash_of(program)
    assert hash_of(program, ["a bound"]) != hash_of(program)
    assert source_of(LIBRARY, NAME, "glsl") == hash_of(program, [b.describe() for b in LIBRARY.bounds[NAME]])
    assert source_of(LIBRARY, NAME, "numpy") != source_of(LIBRARY, NAME, "glsl")


@pytest.mark.nightly
def test_processes_sweep_as_one_process_does() -> None:
    where = {NAME: SWEPT[NAME]}
    jobs = [Job(TASK, NAME, "numpy", k * 5000, k * 5000 + 5000) for k in range(4)]
    assert sweep(LIBRARY, where, jobs, Processes(2)) == sweep(LIBRARY, where, jobs, Here())


def test_a_miss_is_seen_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
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
