"""Running mutants, several at a time, and what came of each."""

from __future__ import annotations

import random
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path

from conformance.mutation.isolated import (
    KILLED,
    REFUSED,
    SURVIVED,
    TIMED_OUT,
    Change,
    Session,
    Trial,
    dependants,
    warm_up,
)
from conformance.mutation.plan import Group, Subject, change_of, excuse, mutants_of
from conformance.mutation.seen import Seen
from conformance.mutation.sites import Mutant

SEED = 20_260
EQUIVALENT = "equivalent"
TABLES_MODULE = "codegen.intervals.tables"
"""The module that reads the accuracy tables."""
LEAST_LIMIT, SLOWER = 20.0, 10.0
"""A mutant may take so many seconds, and so many times as long as the tests do without it."""

Job = tuple[Subject, Mutant]
Told = Callable[["Result"], None]


class BaselineError(Exception):
    """The tests of a group fail without any mutant: nothing can be said."""


@dataclass(frozen=True)
class Result:
    """What came of one mutant: KILLED, SURVIVED, EQUIVALENT, TIMED_OUT or, in the library, REFUSED."""

    mutant: Mutant
    outcome: str
    seconds: float


def all_jobs(group: Group) -> list[Job]:
    """Every mutant of a group."""
    return [(subject, mutant) for subject in group.subjects for mutant in mutants_of(group, subject)]


def sampled(group: Group, count: int, seed: int = SEED) -> list[Job]:
    """A fixed sample; planted faults always belong to the oracle's."""
    jobs = [job for job in all_jobs(group) if not excuse(job[1])]
    return random.Random(seed).sample(jobs, min(count, len(jobs)))


def run(group: Group, jobs: Sequence[Job], workers: int, told: Told = lambda _: None) -> list[Result]:
    """Try every mutant; `told` hears of each as it is done. Raises BaselineError."""
    trying = _try_shaders if group.name == "library" else _try_modules
    results = []
    for result in trying(group, jobs, workers):
        results.append(result)
        told(result)
    return results


def _settled(mutant: Mutant, outcome: str, seconds: float) -> Result:
    """Survivors that are known to be equivalent are told apart."""
    known = outcome == SURVIVED and excuse(mutant)
    return Result(mutant, EQUIVALENT if known else outcome, seconds)


@dataclass
class Prepared:
    """What the mutants of some files share: tests, modules to import anew, and which test sees what."""

    session: Session
    seen: Seen
    subject: Subject

    @property
    def limit(self) -> float:
        """Seconds for all tests of one mutant: many times what they take, on a machine that is shared."""
        return LEAST_LIMIT + SLOWER * self.seen.seconds


def prepare(group: Group, subjects: Sequence[Subject]) -> dict[Subject, Prepared]:
    """Import what the tests need, run them once without a mutant, watched. Raises BaselineError.

    The subjects share their tests.
    """
    tests, paths = subjects[0].tests, tuple(s.path for s in subjects)
    if warm_up(tests):
        raise BaselineError(f"{' '.join(tests)} cannot be collected")
    stale = {s: frozenset(dependants(module_of(s.path))) for s in subjects}
    with tempfile.TemporaryDirectory() as folder:
        notes = Path(folder) / "seen.json"
        union = frozenset[str]().union(*stale.values())
        watched = Session(tests, union, without=group.without, watched=paths, notes=notes)
        trial = Trial(watched, Change(paths[0]), 20 * group.limit)
        if trial.wait() != SURVIVED:
            told = trial.output.decode(errors="replace")[-3000:]
            raise BaselineError(f"{' '.join(tests)} fail without a mutant:\n{told}")
        seen = Seen.read(notes)
    return {s: Prepared(Session(tests, stale[s], without=group.without), seen, s) for s in subjects}


def module_of(path: str) -> str:
    """The module whose import reads a file: its own, or the one that loads tables."""
    return path.removesuffix(".py").replace("/", ".") if path.endswith(".py") else TABLES_MODULE


def attempt(group: Group, ready: Prepared, mutant: Mutant) -> Iterator[Trial]:
    """First the tests that see the changed function, quickest first, then all others."""
    subject = ready.subject
    change = change_of(group, subject, mutant)
    seeing = tuple(ready.seen.by(subject.path, subject.text, mutant.line)) if subject.is_module else ()
    if seeing:
        yield Trial(replace(ready.session, chosen=seeing), change, ready.limit)
    others = replace(ready.session, excluded=seeing)
    if len(seeing) < len(ready.seen.tests):
        yield Trial(others, change, ready.limit)


def _try_modules(group: Group, jobs: Sequence[Job], workers: int) -> Iterator[Result]:
    """Files with the same tests together, so that what their mutants share is prepared once."""
    together: dict[tuple[str, ...], list[Subject]] = {}
    for subject in dict.fromkeys(subject for subject, _ in jobs):
        together.setdefault(subject.tests, []).append(subject)
    for subjects in together.values():
        ready = prepare(group, subjects)
        waiting = [job for job in jobs if job[0] in ready][::-1]
        running: list[_Running] = []
        while waiting or running:
            while waiting and len(running) < workers:
                subject, mutant = waiting.pop()
                running.append(_Running(mutant, attempt(group, ready[subject], mutant)))
            first = running.pop(0)
            if first.wait() == SURVIVED and first.go_on():
                running.append(first)
            else:
                yield _settled(first.mutant, first.outcome, first.seconds)


class _Running:
    """A mutant on its way through its trials."""

    def __init__(self, mutant: Mutant, trials: Iterator[Trial]) -> None:
        self.mutant, self.trials, self.seconds = mutant, trials, 0.0
        self.outcome = SURVIVED
        self.go_on()

    def go_on(self) -> bool:
        """Start the next trial, if there is one."""
        self.started = time.perf_counter()
        self.trial = next(self.trials, None)
        return self.trial is not None

    def wait(self) -> str:
        """What came of the trial under way."""
        if self.trial is not None:
            self.outcome = self.trial.wait()
            self.seconds += time.perf_counter() - self.started
        return self.outcome


def _try_shaders(group: Group, jobs: Sequence[Job], workers: int) -> Iterator[Result]:
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        tasks = [(group, subject, mutant) for subject, mutant in jobs]
        yield from pool.map(_try_shader, tasks, chunksize=4)


def _try_shader(task: tuple[Group, Subject, Mutant]) -> Result:
    from conformance.mutation.shaders import judge

    started = time.perf_counter()
    return _settled(task[2], judge(*task), time.perf_counter() - started)


@dataclass(frozen=True)
class Tally:
    """The figures of a group."""

    killed: int
    survived: int
    equivalent: int
    refused: int

    @property
    def share(self) -> float:
        """Killed among those that can be killed."""
        return self.killed / max(self.killed + self.survived, 1)


def tally(results: Sequence[Result]) -> Tally:
    """Counts by outcome; a mutant on which the tests never end is noticed, too."""

    def count(*outcomes: str) -> int:
        return sum(r.outcome in outcomes for r in results)

    return Tally(count(KILLED, TIMED_OUT), count(SURVIVED), count(EQUIVALENT), count(REFUSED))
