"""Random programs as jobs of an executor: many processes, and a program that ends one of them is found.

A compiler that panics takes its process with it. The job of such a program fails on every attempt; it is then
cut in halves until the program stands alone, which is a finding of its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from conformance.executor import Executor, Job, Result
from conformance.fuzz.case import make_case
from conformance.fuzz.engine import BATCH, Finding, Tally, run_cases
from targets import forget_programs, open_runtime

TASK = "conformance.fuzz.task:run"
PIECE = 5 * BATCH
"""Programs of one job: some ten seconds."""
COUNTS = ("results", "open", "exact", "rearranged")
ENDED = "ended"
"""Kind of finding: the process ended, or an exception came that the judge does not know."""


def run(job: Job) -> dict[str, Any]:
    """The programs from start to stop of the job's seed, on all of its targets."""
    tally = Tally()
    run_cases(range(job.start, job.stop), job.seed, [open_runtime(target) for target in job.targets], tally)
    forget_programs()  # none of them is run again
    return {
        "programs": tally.programs,
        **{name: dict(getattr(tally, name)) for name in COUNTS},
        "findings": [[f.case.number, f.kind, f.backend, f.detail, f.lane] for f in tally.findings],
    }


def pieces(seed: int, first: int, count: int, targets: Sequence[str]) -> list[Job]:
    """The jobs of so many programs."""
    stop = first + count
    target = ",".join(targets)
    return [Job(TASK, "", target, k, min(k + PIECE, stop), seed=seed) for k in range(first, stop, PIECE)]


def run_jobs(
    executor: Executor, jobs: Sequence[Job], progress: Callable[[Result], None] = lambda _: None
) -> Tally:
    """What all jobs find together."""
    tally = Tally()
    waiting = list(jobs)
    while waiting:
        again: list[Job] = []
        for result in executor.run(waiting):
            if result.done:
                _add(tally, result)
            else:
                again += _closer(tally, result)
            progress(result)
        waiting = again
    tally.findings.sort(key=lambda f: (f.case.number, f.kind, f.backend))
    return tally


def _add(tally: Tally, result: Result) -> None:
    tally.programs += result.data["programs"]
    for name in COUNTS:
        counts: Counter[str] = getattr(tally, name)
        counts.update(result.data[name])
    for number, kind, backend, detail, lane in result.data["findings"]:
        tally.findings.append(Finding(make_case(result.job.seed, number), kind, backend, detail, lane))


def _closer(tally: Tally, result: Result) -> Iterator[Job]:
    """Halves of a job that failed; of one program: each of its targets alone; then it is a finding."""
    job = result.job
    if job.stop - job.start > 1:
        middle = (job.start + job.stop) // 2
        yield replace(job, stop=middle)
        yield replace(job, start=middle)
    elif len(job.targets) > 1:
        yield from (replace(job, target=target) for target in job.targets)
    else:
        tally.programs += 1
        tally.findings.append(Finding(make_case(job.seed, job.start), ENDED, job.target, result.error))
