"""Executors: the same results everywhere; a worker that dies loses nothing; no work without the driver."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor as Pool
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from conformance.executor import Here, Job, Processes, Result, local, open_executor, worker

ECHO = "conformance.executor.jobs:echo"


def jobs(count: int, target: str = "numpy") -> list[Job]:
    return [Job(ECHO, "f", target, 10 * k, 10 * k + 10, seed=k) for k in range(count)]


def told(results: Iterator[Result]) -> dict[str, tuple[dict[str, Any], str]]:
    found = [(r.job.identity, (r.data, r.error)) for r in results]
    assert len(found) == len(dict(found)), "a job has two results"
    return dict(found)


def test_one_process_answers_every_job() -> None:
    answers = told(Here().run(jobs(4)))
    assert [data["sum"] for data, _ in answers.values()] == [45, 145, 245, 345]


def test_processes_agree_with_one_process() -> None:
    assert told(Processes(2).run(jobs(12))) == told(Here().run(jobs(12)))


def test_what_a_task_raises_is_its_result() -> None:
    (result,) = Here().run([Job(ECHO, "f", "numpy", options=(("raise", "no"),))])
    assert not result.done
    assert result.error == "ValueError: no"


def test_a_target_without_driver_is_told_not_tried() -> None:
    for executor in (Here(), Processes(2)):
        answers = told(executor.run([*jobs(2), *jobs(1, "metal")]))
        assert sorted(error for _, error in answers.values()) == ["", "", "there is no target metal"]
    (both,) = Here().run(jobs(1, "numpy,metal"))
    assert both.error == "there is no target metal"


def test_a_process_that_dies_loses_nothing(tmp_path: Path) -> None:
    marker = tmp_path / "fatal"
    marker.touch()
    fatal = Job(ECHO, "f", "numpy", 0, 5, options=(("fatal", str(marker)),))
    answers = told(Processes(2).run([fatal, *jobs(5)]))
    assert not marker.exists(), "the process was never killed"
    assert len(answers) == 6
    assert answers[fatal.identity] == ({"sum": 10, "target": "numpy"}, "")
    assert all(not error for _, error in answers.values())


@pytest.mark.parametrize("times", [1, 2])
def test_an_interrupted_run_ends(times: int, tmp_path: Path) -> None:
    """Ctrl-C reaches every process of the terminal; the workers end all the same, and so does the parent.

    A second one, while the workers finish what they have, ends them at once: nobody waits for the other.
    """
    begun = tmp_path / "begun"
    program = (
        "import pathlib\n"
        "from conformance.executor import Job, Processes\n"
        "if __name__ == '__main__':\n"
        "    jobs = [Job('conformance.unit.cluster_tasks:slow', 'f', 'numpy', seed=k) for k in range(999)]\n"
        "    for result in Processes(2).run(jobs):\n"
        f"        pathlib.Path({str(begun)!r}).touch()\n"
    )
    (tmp_path / "program.py").write_text(program)
    command = [sys.executable, str(tmp_path / "program.py")]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    with subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as run:
        try:
            while not begun.exists():
                assert run.poll() is None
                time.sleep(0.05)
            for _ in range(times):
                os.killpg(run.pid, signal.SIGINT)
                time.sleep(0.05)
            _, errors = run.communicate(timeout=30)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(run.pid, signal.SIGKILL)
    assert run.returncode not in (0, None)
    assert errors.count("KeyboardInterrupt") == times, errors


class BreaksWhenIdle(Pool):
    """A pool whose process died between two jobs: it takes no more. Every second one is whole."""

    opened = refused = 0

    def __init__(self, *_: Any, **__: Any) -> None:
        type(self).opened += 1
        self.broken = self.opened % 2 == 1
        super().__init__(max_workers=1)

    def submit(self, *call: Any, **named: Any) -> Any:
        if self.broken:
            type(self).refused += 1
            assert self.refused < 100, "a broken pool is asked for ever"
            raise BrokenProcessPool
        return super().submit(*call, **named)


def test_a_process_that_dies_while_idle_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(local, "ProcessPoolExecutor", BreaksWhenIdle)
    jobs = [Job("conformance.executor.jobs:echo", "f", "numpy", 0, k + 1) for k in range(3)]
    assert {r.job: r.data for r in Processes(1).run(jobs)} == {r.job: r.data for r in Here().run(jobs)}
    assert (BreaksWhenIdle.opened, BreaksWhenIdle.refused) == (2, 1)


def test_a_process_that_has_grown_is_replaced() -> None:
    """After three jobs it holds too much; it does what it was given, one more, and another one goes on."""
    jobs = [Job("conformance.unit.cluster_tasks:hoard", "f", "numpy", seed=k) for k in range(6)]
    answers = list(Processes(1).run(jobs))
    assert sorted(r.job.seed for r in answers) == list(range(6)) and all(r.done for r in answers)
    assert sorted(r.data["kept"] for r in answers) == [1, 1, 2, 2, 3, 4]
    assert len({r.data["pid"] for r in answers}) == 2


def test_a_process_has_grown_when_it_holds_much_and_more_than_at_first() -> None:
    assert worker.has_grown(worker.LARGE // 4, worker.LARGE + 1)
    assert not worker.has_grown(worker.LARGE // 4, worker.LARGE)
    assert not worker.has_grown(worker.LARGE, worker.LARGE + 1), "it needs as much"
    assert not worker.has_grown(0, 0), "the system does not tell"


def test_options_choose_the_executor() -> None:
    assert isinstance(open_executor(1, None), Here)
    chosen = open_executor(3, None)
    assert isinstance(chosen, Processes)
    assert chosen.workers == 3


@pytest.fixture(scope="module")
def local_cluster() -> Iterator[Any]:
    """Two workers, each a process of its own; only the first may run OpenCL."""
    distributed = pytest.importorskip("distributed", reason="distributed is not installed: vair[cluster]")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0
    ) as cluster:
        yield cluster


@pytest.fixture
def on_cluster(local_cluster: Any) -> Iterator[Any]:
    from conformance.executor.cluster import Cluster, DriverResources

    only = {"0": ("numpy", "opencl"), "1": ("numpy",)}
    executor = Cluster(local_cluster.scheduler_address, DriverResources(only))
    yield executor
    executor.close()


def test_cluster_agrees_with_one_process(on_cluster: Any) -> None:
    assert told(on_cluster.run(jobs(30))) == told(Here().run(jobs(30)))


def test_a_worker_without_the_driver_is_never_given_its_work(on_cluster: Any) -> None:
    task = "conformance.unit.cluster_tasks:who"
    declared = on_cluster.resources()
    able = [name for name, names in declared.items() if any("opencl" in n for n in names)]
    if not able:
        pytest.skip("opencl: no worker of this machine has the driver")
    assert able == ["0"]

    def workers(target: str, count: int) -> set[str]:
        found = list(on_cluster.run([Job(task, "f", target, seed=k) for k in range(count)]))
        assert [result.error for result in found] == [""] * count
        return {result.data["worker"] for result in found}

    assert workers("opencl", 12) == {"0"}
    assert workers("numpy", 12) == {"0", "1"}
    (missing,) = on_cluster.run([Job(task, "f", "glsl")])
    assert missing.error == "none of 2 workers has the driver of glsl"
    assert workers("numpy,opencl", 1) == {"0"}


def test_a_worker_killed_in_mid_run_loses_nothing(
    on_cluster: Any, local_cluster: Any, tmp_path: Path
) -> None:
    task = "conformance.unit.cluster_tasks:slow"
    asked = [Job(task, "f", "numpy", seed=k) for k in range(12)]
    running = on_cluster.run(asked)
    first = next(running)
    os.kill(first.data["pid"], signal.SIGKILL)
    rest = list(running)
    answers = {r.job.seed: r.data["square"] for r in [first, *rest]}
    assert answers == {k: k * k for k in range(12)}
    assert len({r.data["pid"] for r in [first, *rest]}) >= 2
    assert all(r.done for r in rest)


class Vanishing:
    """A scheduler's client whose workers do two jobs and are gone."""

    def __init__(self, *_: Any, **__: Any) -> None:
        from conformance.executor.cluster import resource, source_hash

        self.workers = [{"name": "0", "resources": {resource("numpy", source_hash()): 1.0}}]
        self.cancelled = 0

    def register_plugin(self, plugin: Any) -> None:
        pass

    def scheduler_info(self) -> dict[str, Any]:
        return {"workers": dict(enumerate(self.workers))}

    def submit(self, perform: Any, job: Job, **_: Any) -> Any:
        client = self

        class Future:
            status = "pending"

            def add_done_callback(self, done: Any) -> None:
                if job.seed < 2:
                    self.status = "finished"
                    done(self)
                else:
                    client.workers.clear()

            def result(self) -> Result:
                found: Result = perform(job)
                return found

            def cancel(self) -> None:
                client.cancelled += 1

        return Future()


@pytest.mark.timeout(60)
def test_work_of_workers_that_are_all_gone_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed", reason="distributed is not installed: vair[cluster]")
    from conformance.executor import cluster

    monkeypatch.setattr(cluster, "_client", Vanishing)
    monkeypatch.setattr(cluster, "PATIENCE_SECONDS", 0.05)
    executor = cluster.Cluster("tcp://192.0.2.1:8786")
    answers = told(executor.run(jobs(8)))
    assert sorted(error for _, error in answers.values()) == [
        "",
        "",
        *["none of 0 workers has the driver of numpy"] * 6,
    ]
    assert executor.client.cancelled == cluster.QUEUED_PER_WORKER, "the others were never handed out"
