"""Every pair as jobs of an executor: one relation with some of its subjects on one target."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from codegen.library import Library, load_library
from conformance.executor import Executor, Job, Result
from conformance.executor.state import State
from conformance.fuzz.case import Case
from conformance.metamorphic import inputs, source
from conformance.metamorphic.engine import Count, Report, run_pairs
from conformance.metamorphic.pairs import Pair, draw, input_pair
from conformance.metamorphic.plan import SEED, library_pair, program_pair, random_programs
from conformance.sources import hash_of
from targets import open_runtime

TASK = "conformance.metamorphic.task:run"
PROGRAMS = 200
"""Random programs that are rewritten."""
SUBJECTS = 50
"""Functions or programs of one job: some ten seconds."""
SOURCES = ("conformance/metamorphic", "conformance/fuzz", "conformance/programs", "codegen/intervals")
"""What pairs and their verdicts depend on, beside the library."""


def pieces(library: Library, targets: Sequence[str], lanes: int) -> list[Job]:
    """The jobs of all pairs, target by target; `function` of a job is kind and relation."""
    counts = {f"inputs/{r.name}": len(r.functions) for r in inputs.RELATIONS}
    counts |= {f"library/{r.name}": len(library.public) for r in source.RELATIONS}
    counts |= {f"programs/{r.name}": PROGRAMS for r in source.RELATIONS}
    options = (("lanes", str(lanes)),)
    return [
        Job(TASK, what, target, start, min(start + SUBJECTS, count), options=options)
        for target in targets
        for what, count in counts.items()
        for start in range(0, count, SUBJECTS)
    ]


def run(job: Job) -> dict[str, Any]:
    """The pairs of one job on its target."""
    kind, name = job.function.split("/")
    lanes, part = int(dict(job.options)["lanes"]), slice(job.start, job.stop)
    library, cases = programs() if kind == "programs" else (load_library(), [])
    found: Iterator[Pair | None]
    if kind == "inputs":
        (relation,) = (r for r in inputs.RELATIONS if r.name == name)
        functions = map(library.function, relation.functions[part])
        found = (input_pair(relation, f, draw(f, lanes, SEED)) for f in functions)
    else:
        (rewriting,) = (r for r in source.RELATIONS if r.name == name)
        if kind == "library":
            found = (library_pair(library, rewriting, f, lanes) for f in [*library.public.values()][part])
        else:
            found = (program_pair(library, rewriting, case, lanes) for case in cases[part])
    runtimes = [open_runtime(target) for target in job.targets]
    report = run_pairs(library, (pair for pair in found if pair is not None), runtimes, lanes)
    return {
        "source": source_hash(),
        "counts": {name: asdict(count) for name, count in report.counts.items()},
        "failures": report.failures,
    }


@cache
def programs() -> tuple[Library, list[Case]]:
    """The random programs, made once per process."""
    with tempfile.TemporaryDirectory() as folder:
        library, cases = random_programs(Path(folder), PROGRAMS)
        library.select([case.entry for case in cases])  # read while the files are there
        return library, cases


@cache
def source_hash() -> str:
    """Of all that pairs and verdicts depend on."""
    return hash_of(SOURCES, more=load_library().select().source_hash)


def run_jobs(
    executor: Executor,
    jobs: Sequence[Job],
    state: State | None = None,
    progress: Callable[[Result], None] = lambda _: None,
) -> tuple[Report, list[str]]:
    """What all jobs find together, and those that were not done with the reason; done ones are remembered."""
    report, undone = Report(), list[str]()
    known = {job: state.find(job, source_hash()) for job in jobs} if state else dict.fromkeys(jobs)
    for job, data in known.items():
        if data is not None:
            _add(report, data)
            progress(Result(job, data))
    for result in executor.run([job for job, data in known.items() if data is None]):
        progress(result)
        if not result.done:
            undone.append(f"{result.job.identity}: {result.error}")
            continue
        _add(report, result.data)
        if state and result.data["source"] == source_hash():
            state.add(result, source_hash())
    return report, undone


def _add(report: Report, data: dict[str, Any]) -> None:
    for name, counts in data["counts"].items():
        total = report.counts.setdefault(name, Count())
        for key, count in counts.items():
            setattr(total, key, getattr(total, key) + count)
    report.failures += data["failures"]
