"""Runs random programs on every backend and judges what comes back."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Array, Value
from codegen.intervals import Permitted
from codegen.ir.verify import MalformedIRError, verify_selection
from codegen.library import Library
from conformance.fuzz import python_oracle
from conformance.fuzz.case import Case, draw_inputs, make_case
from conformance.fuzz.source import write
from conformance.programs import batch, judge, rearranged
from targets import BuildFailed, Runtime

LANES = 32
"""Inputs of each program."""
BATCH = 40
"""Programs compiled together."""
PYTHON_LANES = (0, 1, 20, 31)
"""Lanes that Python itself executes."""
NUMPY, PYTHON = "numpy", "python"
"""Backends without a device: the IR's evaluator in float32, and Python executing the source."""


@dataclass(frozen=True)
class Finding:
    """What went wrong with one program. `kind`: refused, malformed, crash, build, value or ended."""

    case: Case
    kind: str
    backend: str
    detail: str
    lane: int = 0

    @property
    def signature(self) -> tuple[str, str]:
        """What a reduced program must still show."""
        return self.kind, self.backend

    def __str__(self) -> str:
        return f"{self.kind} on {self.backend}: {self.detail}\n  replay: {self.case.replay}"


@dataclass
class Tally:
    """Counts of a run."""

    programs: int = 0
    results: Counter[str] = field(default_factory=Counter)
    open: Counter[str] = field(default_factory=Counter)
    exact: Counter[str] = field(default_factory=Counter)
    rearranged: Counter[str] = field(default_factory=Counter)
    findings: list[Finding] = field(default_factory=list)

    def lines(self) -> list[str]:
        """A summary, one line per backend."""
        lines = [f"{self.programs} programs, {len(self.findings)} findings"]
        for backend, count in self.results.items():
            share, exact = self.open[backend] / max(count, 1), self.exact[backend] / max(count, 1)
            lines.append(
                f"  {backend:8} {count} results judged; {share:.1%} unbounded, {exact:.1%} exact, "
                f"{self.rearranged[backend]} rearranged"
            )
        return lines


def run_cases(numbers: Iterable[int], seed: int, runtimes: Sequence[Runtime], tally: Tally) -> None:
    """Make, run and judge the programs of these numbers, in batches."""
    waiting = list(numbers)
    for start in range(0, len(waiting), BATCH):
        run_batch([make_case(seed, n) for n in waiting[start : start + BATCH]], runtimes, tally)


def run_batch(cases: Sequence[Case], runtimes: Sequence[Runtime], tally: Tally) -> None:
    """Run programs that are compiled together."""
    with tempfile.TemporaryDirectory() as folder:
        library = write(Path(folder), cases)
        sound = [case for case in cases if _lower(library, case, tally)]
        tally.programs += len(cases)
        jobs = {
            c: batch.Job(c.entry, draw_inputs(c, library.function(c.entry).parameters, LANES)) for c in sound
        }
        allowed: dict[tuple[Case, str], Permitted] = {}

        def check(case: Case, backend: str, value: Value, lanes: Sequence[int] | None = None) -> None:
            table = judge.table_of(backend)
            key = case, table
            if key not in allowed:
                allowed[key] = judge.intervals(library, case.entry, jobs[case].inputs, backend)
            verdict = _verdict(library, jobs[case], backend, allowed[key], value, lanes)
            _judge(tally, case, backend, verdict, value, lanes)

        for case in sound:
            inputs = dict(jobs[case].inputs)
            function = library.function(case.entry)
            check(case, NUMPY, evaluate(library, case.entry, inputs))
            check(case, PYTHON, python_oracle.run(case.text, function, inputs, PYTHON_LANES), PYTHON_LANES)
        for runtime in runtimes:
            for case, value in _on_device(library, jobs, runtime, tally):
                check(case, runtime.device.target, value)


def _lower(library: Library, case: Case, tally: Tally) -> bool:
    """Whether the front end takes the program and makes well-formed IR of it; a finding where not."""
    try:
        verify_selection(library.select([case.entry]).functions)
    except UserError as e:
        tally.findings.append(Finding(case, "refused", "front end", str(e)))
    except MalformedIRError as e:
        tally.findings.append(Finding(case, "malformed", "front end", str(e)))
    except Exception as e:
        tally.findings.append(Finding(case, "crash", "front end", f"{type(e).__name__}: {e}"))
    else:
        return True
    return False


def _on_device(
    library: Library, jobs: dict[Case, batch.Job], runtime: Runtime, tally: Tally
) -> list[tuple[Case, Value]]:
    """Results of all programs; where the text is refused, halves are tried until the culprits are alone."""
    if not jobs:
        return []
    try:
        values = batch.run(library, list(jobs.values()), runtime, LANES)
    except BuildFailed as e:
        if len(jobs) == 1:
            tally.findings.append(Finding(next(iter(jobs)), "build", runtime.device.target, str(e)))
            return []
        items = list(jobs.items())
        middle = len(items) // 2
        halves = dict(items[:middle]), dict(items[middle:])
        return [pair for half in halves for pair in _on_device(library, half, runtime, tally)]
    return list(zip(jobs, values, strict=True))


@dataclass(frozen=True)
class Judged:
    """Intervals of some lanes, which lanes are wrong, and which are explained by rearrangement."""

    allowed: Permitted
    wrong: Array
    rearranged: Array


def _verdict(
    library: Library,
    job: batch.Job,
    backend: str,
    allowed: Permitted,
    value: Value,
    lanes: Sequence[int] | None,
) -> Judged:
    if lanes is not None:
        allowed = select(allowed, lanes)
    wrong = judge.judge(allowed, value).wrong
    why = np.zeros_like(wrong)
    if wrong.any() and lanes is None:
        why = wrong & rearranged.explained(library, job.name, job.inputs, backend, value)
    return Judged(allowed, wrong & ~why, why)


def _judge(
    tally: Tally, case: Case, backend: str, judged: Judged, value: Value, lanes: Sequence[int] | None
) -> None:
    allowed = judged.allowed
    tally.results[backend] += len(judged.wrong)
    tally.open[backend] += int((~allowed.guaranteed).sum())
    tally.exact[backend] += int((allowed.guaranteed & (judge.relative_width(allowed) == 0.0)).sum())
    tally.rearranged[backend] += int(judged.rearranged.sum())
    bad = np.flatnonzero(judged.wrong)
    if len(bad):
        k = int(bad[0])
        lane = k if lanes is None else lanes[k]
        detail = (
            f"lane {lane}: got {pick(value, k)}, permitted {pick(allowed.low, k)} to {pick(allowed.high, k)}"
        )
        tally.findings.append(Finding(case, "value", backend, detail, lane))


def select(allowed: Permitted, lanes: Sequence[int]) -> Permitted:
    """The intervals of some lanes."""
    index = np.asarray(lanes)
    return Permitted(
        pick(allowed.low, index), pick(allowed.high, index), allowed.codes[index], allowed.causes
    )


def pick(value: Value, lanes: Any) -> Any:
    """Some lanes of a value."""
    if isinstance(value, dict):
        return {n: pick(v, lanes) for n, v in value.items()}
    return value[lanes]
