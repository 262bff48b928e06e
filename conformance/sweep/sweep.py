"""Sweeping: the pieces that are not done yet through an executor, then one entry per function and target."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from codegen.library import Library
from conformance.executor import Executor, Job, Result
from conformance.sweep.positions import Positions
from conformance.sweep.record import Entry, joined
from conformance.sweep.state import State


def sweep(
    library: Library,
    swept: dict[str, Positions],
    jobs: Iterable[Job],
    executor: Executor,
    state: State | None = None,
    progress: Callable[[Result], None] = lambda _: None,
) -> tuple[list[Entry], dict[Job, str]]:
    """One entry per function and target, and the pieces that failed with the reason.

    state  pieces done before are taken from it, finished ones added to it
    """
    sources = {name: library.select([name]).source_hash for name in swept}
    pieces: dict[tuple[str, str], list[tuple[Job, Entry]]] = {}
    failed: dict[Job, str] = {}
    missing: list[Job] = []

    def finished(job: Job, data: Entry) -> None:
        pieces.setdefault((job.function, job.target), []).append((job, data))

    for job in jobs:
        data = state.find(job, sources[job.function]) if state else None
        if data is None:
            missing.append(job)
        else:
            finished(job, data)
            progress(Result(job, data))
    for result in executor.run(missing):
        progress(result)
        if result.done:
            finished(result.job, result.data)
            if state:
                state.add(result, sources[result.job.function])
        else:
            failed[result.job] = result.error
    entries = [joined(found, swept[name].count, sources[name]) for (name, _), found in pieces.items()]
    return entries, failed
