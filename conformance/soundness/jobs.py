"""What is not swept yet as jobs of an executor, and the record that grows with their results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from codegen.library import Library
from conformance.executor import Executor, Job, Result
from conformance.soundness import record
from conformance.soundness.sweep import BATCH, TASK

BATCHES = 4
"""Batches of one job at most: every function is swept a little before any is swept a lot."""


def missing(
    library: Library, names: Sequence[str], entries: Mapping[str, record.Entry], points: int
) -> Iterator[Job]:
    """The batches that are not recorded of the present sources, BATCHES of each function in turn."""
    wanted = -(-points // BATCH)
    done = {name: record.batches(library, entries.get(name)) for name in names}
    for turn in range(0, wanted, BATCHES):
        for name in names:
            start, stop = max(turn, done[name]), min(turn + BATCHES, wanted)
            if start < stop:
                yield Job(TASK, name, "numpy", start, stop)


def sweep_missing(
    library: Library, executor: Executor, jobs: Sequence[Job], entries: dict[str, record.Entry]
) -> Iterator[Result]:
    """Do the jobs; each result is put into the entries, then yielded.

    A result is put aside that does not continue what is recorded, as when an earlier job failed: its points
    are swept again the next time.
    """
    for result in executor.run(jobs):
        name, found = result.job.function, result.data
        if result.done and result.job.start == 0:
            entries[name] = found
        elif result.done and record.batches(library, entries.get(name)) == result.job.start:
            entries[name] = record.joined(entries[name], found)
        yield result
