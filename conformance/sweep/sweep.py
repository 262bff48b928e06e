"""Sweeping: the pieces that are not done yet through an executor, then one entry per function and target."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from codegen.library import Library
from conformance.executor import Executor, Job, Result
from conformance.executor.state import State
from conformance.sweep.positions import Positions
from conformance.sweep.record import Entry, joined
from conformance.sweep.source import source_of
from conformance.sweep.task import TOGETHER


def sweep(
    library: Library,
    swept: dict[str, Positions],
    jobs: Iterable[Job],
    executor: Executor,
    state: State | None = None,
    progress: Callable[[Result], None] = lambda _: None,
    together: bool = True,
) -> tuple[list[Entry], dict[Job, str]]:
    """One entry per function and target, and the pieces that failed with the reason.

    jobs      of one target each
    state     pieces done before are taken from it, finished ones added to it
    together  whether the targets of a piece are swept by one worker, which computes the reference once;
              for workers none of which has the drivers of all targets: no
    """
    source = functools.cache(functools.partial(source_of, library))
    pieces: dict[tuple[str, str], list[tuple[Job, Entry]]] = {}
    failed: dict[Job, str] = {}
    missing: list[Job] = []

    def finished(job: Job, data: Entry) -> None:
        pieces.setdefault((job.function, job.target), []).append((job, data))

    for job in jobs:
        data = state.find(job, source(job.function, job.target)) if state else None
        if data is None:
            missing.append(job)
        else:
            finished(job, data)
            progress(Result(job, data))
    for result in one_by_one(executor, missing) if together else executor.run(missing):
        progress(result)
        current = source(result.job.function, result.job.target)
        if not result.done:
            failed[result.job] = result.error
        elif result.data["source"] != current:
            failed[result.job] = "its source changed while it was swept"
        else:
            finished(result.job, result.data)
            if state:
                state.add(result, current)
    entries = [
        joined(found, swept[name].count, source(name, target)) for (name, target), found in pieces.items()
    ]
    return entries, failed


def one_by_one(executor: Executor, jobs: Iterable[Job]) -> Iterator[Result]:
    """A result per job, where the same piece of several targets is given to the executor as one job."""
    groups: dict[Job, list[Job]] = {}
    for job in jobs:
        groups.setdefault(replace(job, task=TOGETHER, target=""), []).append(job)
    given = {
        replace(job, target=",".join(member.target for member in members)): members
        for job, members in groups.items()
    }
    for result in executor.run(given):
        for job in given[result.job]:
            yield Result(job, result.data.get(job.target, {}), result.error)
