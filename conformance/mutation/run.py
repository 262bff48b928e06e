"""Running mutants, several at a time, and what came of each."""

from __future__ import annotations

import hashlib
import random
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from math import inf, isinf
from multiprocessing import get_context

from conformance.mutation.isolated import (
    KILLED,
    REFUSED,
    ROOT,
    SURVIVED,
    TIMED_OUT,
    Change,
    Session,
    Trial,
    dependants,
)
from conformance.mutation.plan import Group, Subject, change_of, excuse, mutants_of
from conformance.mutation.seen import Seen, within
from conformance.mutation.sites import Mutant
from conformance.mutation.swapped import Alive, Swap
from conformance.mutation.warm import Warm, collected

SEED = 20_260
EQUIVALENT = "equivalent"
TABLES_MODULE = "codegen.intervals.tables"
"""The module that reads the accuracy tables."""
NOTES = ROOT / "build" / "mutation"
"""Where it is kept which tests see what."""
LEAST_LIMIT, SLOWER = 20.0, 10.0
"""A mutant may take so many seconds, and so many times as long as the tests do without it."""

Job = tuple[Subject, Mutant]
Told = Callable[["Result"], None]


class BaselineError(Exception):
    """The tests of a group fail without any mutant: nothing can be said."""


@dataclass(frozen=True)
class Result:
    """What came of one mutant: KILLED, SURVIVED, TIMED_OUT, EQUIVALENT (known, not tried) or REFUSED."""

    mutant: Mutant
    outcome: str
    seconds: float


def all_jobs(group: Group) -> list[Job]:
    """Every mutant of a group."""
    return [(subject, mutant) for subject in group.subjects for mutant in mutants_of(group, subject)]


def sampled(group: Group, count: int, seed: int = SEED) -> list[Job]:
    """A fixed sample; which mutants are known to be equivalent does not change it."""
    jobs = all_jobs(group)
    return random.Random(seed).sample(jobs, min(count, len(jobs)))


def run(
    group: Group,
    jobs: Sequence[Job],
    workers: int,
    told: Told = lambda _: None,
    effort: float = inf,
    ends: float = inf,
) -> list[Result]:
    """Try mutants; `told` hears of each.

    effort  seconds of tests that a mutant meets at most, the quickest that call what it changes: what they
            kill is killed by all tests, too; what survives them may not survive all
    ends    begin none later than this (time.monotonic())

    Raises BaselineError.
    """
    results = [Result(mutant, EQUIVALENT, 0.0) for _, mutant in jobs if excuse(mutant)]

    def keep(result: Result) -> None:
        results.append(result)
        told(result)

    unknown = [job for job in jobs if not excuse(job[1])]
    if group.name == "library":
        _try_shaders(group, unknown, workers, ends, keep)
    else:
        _try_modules(group, unknown, workers, effort, ends, keep)
    return results


@dataclass
class Prepared:
    """What the mutants of some files share: collected tests, modules to import anew, which test sees what."""

    warm: Warm
    alive: Alive
    session: Session
    seen: Seen
    subject: Subject

    def limit(self, chosen: Sequence[str]) -> float:
        """Seconds for tests of one mutant: many times what they take, on a machine that is shared."""
        return LEAST_LIMIT + SLOWER * sum(float(self.seen.tests[name]["s"]) for name in chosen)


def prepare(group: Group, subjects: Sequence[Subject], warm: Warm) -> dict[Subject, Prepared]:
    """Run the tests that are collected once without a mutant, watched. Raises BaselineError.

    The subjects share their tests.
    """
    tests = subjects[0].tests
    # All files of these tests, so that what was seen serves every part of a sample.
    paths = tuple(s.path for s in group.subjects if s.tests == tests)
    notes = NOTES / f"{_hash_of(tests, paths, group.without)}.json"
    if not notes.exists():
        NOTES.mkdir(parents=True, exist_ok=True)
        union = frozenset[str]().union(*(dependants(module_of(path)) for path in paths))
        watched = Session(tests, union, without=group.without, watched=paths, notes=notes)
        trial = Trial(partial(watched.run, Change(paths[0])), 20 * group.limit)
        if trial.wait() != SURVIVED:
            notes.unlink(missing_ok=True)
            told = trial.output.decode(errors="replace")[-3000:]
            raise BaselineError(f"{' '.join(tests)} fail without a mutant:\n{told}")
    seen = Seen.read(notes)
    alive = Alive(ROOT / s.path for s in subjects if s.is_module)
    sessions = {
        s: Session(tests, frozenset(dependants(module_of(s.path))), without=group.without) for s in subjects
    }
    return {s: Prepared(warm, alive, sessions[s], seen, s) for s in subjects}


def _hash_of(tests: Sequence[str], paths: Sequence[str], without: Sequence[str]) -> str:
    """Of the files and of the tests: while neither changes, what was seen of them stays true."""
    files = [*paths, *dict.fromkeys(test.partition("::")[0] for test in tests)]
    texts = [(ROOT / file).read_text(encoding="utf-8") for file in files]
    return hashlib.sha256(repr([*tests, *paths, *without, *texts]).encode()).hexdigest()[:16]


def module_of(path: str) -> str:
    """The module whose import reads a file: its own, or the one that loads tables."""
    return path.removesuffix(".py").replace("/", ".") if path.endswith(".py") else TABLES_MODULE


def attempt(group: Group, ready: Prepared, mutant: Mutant, effort: float) -> Iterator[Trial]:
    """First the tests that see the changed function, quickest first, then all others.

    With an effort of so many seconds, no more than the first of them that fit in.
    """
    subject = ready.subject
    change = change_of(group, subject, mutant)
    seeing = tuple(ready.seen.by(subject.path, subject.text, mutant.line)) if subject.is_module else ()
    swap = _swap(ready, change, mutant)

    def trial(chosen: tuple[str, ...]) -> Trial:
        anew = replace(ready.session, chosen=chosen)
        work = partial(anew.run, change) if swap is None else partial(ready.warm.run, chosen, swap)
        return Trial(work, ready.limit(chosen))

    everything = isinf(effort)
    if seeing:
        seconds = [ready.seen.tests[name]["s"] for name in seeing]
        yield trial(seeing if everything else seeing[: within(seconds, effort)])
    others = tuple(name for name in ready.seen.tests if name not in seeing)
    if others and (everything or not subject.is_module):
        yield trial(others)


def _swap(ready: Prepared, change: Change, mutant: Mutant) -> Swap | None:
    """The functions that a change touches, where it is done by exchanging their code."""
    subject = ready.subject
    if change.tree is None or ready.seen.runs_at_import(subject.path, subject.text, mutant.line):
        return None
    return ready.alive.swap(ROOT / subject.path, subject.text, change.tree)


def _try_modules(
    group: Group, jobs: Sequence[Job], workers: int, effort: float, ends: float, told: Told
) -> None:
    """Files with the same tests together, so that what their mutants share is prepared once."""
    together: dict[tuple[str, ...], list[Job]] = {}
    for job in jobs:
        together.setdefault(job[0].tests, []).append(job)
    for tests, of_these in together.items():
        if time.monotonic() > ends:
            return

        def then(warm: Warm, of_these: list[Job] = of_these) -> None:
            ready = prepare(group, list(dict.fromkeys(subject for subject, _ in of_these)), warm)
            if group.warm and not warm.load(group.warm):
                raise BaselineError(f"{' '.join(group.warm)} fail without a mutant")
            waiting = (_Running(m, attempt(group, ready[s], m, effort)) for s, m in of_these)
            _try_all(waiting, workers, ends, told)

        if refused := collected(tests, group.without, then):
            raise BaselineError(f"{' '.join(tests)} cannot be collected:\n{refused}")


def _try_all(waiting: Iterator[_Running], workers: int, ends: float, told: Told) -> None:
    running: list[_Running] = []
    while True:
        while len(running) < workers and time.monotonic() <= ends:
            if (begun := next(waiting, None)) is None:
                break
            running.append(begun)
        if not running:
            return
        first = running.pop(0)
        if first.wait() == SURVIVED and first.go_on():
            running.append(first)
        else:
            told(Result(first.mutant, first.outcome, first.seconds))


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


def _try_shaders(group: Group, jobs: Sequence[Job], workers: int, ends: float, told: Told) -> None:
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        tasks = [(group, subject, mutant, ends) for subject, mutant in jobs]
        for result in pool.map(_try_shader, tasks):
            if result is not None:
                told(result)


def _try_shader(task: tuple[Group, Subject, Mutant, float]) -> Result | None:
    from conformance.mutation.shaders import judge

    group, subject, mutant, ends = task
    if time.monotonic() > ends:
        return None
    started = time.perf_counter()
    outcome = judge(group, subject, mutant)
    return Result(mutant, outcome, time.perf_counter() - started)


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
