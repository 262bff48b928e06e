"""Running mutants, several at a time, and what came of each."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

from conformance.mutation.isolated import KILLED, SURVIVED, TIMED_OUT, Trial, dependants, warm_up
from conformance.mutation.plan import Group, Subject, excuse, mutants_of, tree_of
from conformance.mutation.sites import Mutant

SEED = 20_260
EQUIVALENT = "equivalent"

Job = tuple[Subject, Mutant]
Told = Callable[["Result"], None]


class BaselineError(Exception):
    """The tests of a group fail without any mutant: nothing can be said."""


@dataclass(frozen=True)
class Result:
    """What came of one mutant: KILLED, SURVIVED, EQUIVALENT, TIMED_OUT or, in the library, "refused"."""

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


def _try_modules(group: Group, jobs: Sequence[Job], workers: int) -> Iterator[Result]:
    """File by file, so that what a file's mutants share is prepared once."""
    for subject in dict.fromkeys(subject for subject, _ in jobs):
        warm_up(subject.tests)
        stale = dependants(subject.path.removesuffix(".py").replace("/", "."))
        trial = Trial(subject.tests, subject.path, None, stale, 4 * group.limit)
        if trial.wait() != SURVIVED:
            told = trial.output.decode(errors="replace")[-3000:]
            raise BaselineError(f"{' '.join(subject.tests)} fail without a mutant:\n{told}")
        running: list[tuple[Mutant, Trial, float]] = []
        waiting = [mutant for s, mutant in jobs if s == subject][::-1]
        while waiting or running:
            while waiting and len(running) < workers:
                mutant = waiting.pop()
                tree = tree_of(group, subject, mutant)
                trial = Trial(subject.tests, subject.path, tree, stale, group.limit)
                running.append((mutant, trial, time.perf_counter()))
            mutant, trial, started = running.pop(0)
            outcome = trial.wait()
            yield _settled(mutant, outcome, time.perf_counter() - started)


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

    return Tally(count(KILLED, TIMED_OUT), count(SURVIVED), count(EQUIVALENT), count("refused"))
