"""Holds the intervals of one function against enclosures of the exact value: many points, all tables."""

from __future__ import annotations

import functools
import time
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from codegen.intervals import TABLES, Table, load_table, permitted
from codegen.library import Library, load_library
from conformance import cases
from conformance.check.draws import Draw, length
from conformance.check.operations import operations
from conformance.check.sample import rows, together
from conformance.executor import Job
from conformance.soundness.enclosure import Array
from conformance.soundness.held import Held, either_way, held, holds, precisely
from conformance.soundness.walk import enclosed
from conformance.sources import hash_of

TASK = "conformance.soundness.sweep:run"
BATCH = 1 << 16
"""Random points drawn at a time: batch k is the same in every sweep."""
PART = 1 << 14
"""Points judged at a time: what numpy works on stays near the processor."""
HARD = 1000
"""Points of a family that has no number of its own, such as the ends of domains."""
MOST_HARD = 20_000
"""Points of one family at most: each stored point with each parameter that it fits comes first."""
PRECISE = 2048
"""Lanes of a part that are undecided under some table and evaluated in 50 digits; others stay undecided."""
INTERVALS = "codegen/intervals"


@dataclass
class Count:
    """Lanes under one table: inside by enclosure, inside by 50 digits, not promised, undecided, outside."""

    enclosed: int = 0
    precise: int = 0
    open: int = 0
    undecided: int = 0
    outside: int = 0

    def add(self, verdict: Held, looked_at: int, inside: Array) -> None:
        """Count a batch, of whose undecided lanes some were looked at in 50 digits."""
        self.enclosed += int(verdict.inside.sum())
        self.open += int(verdict.open.sum())
        self.precise += int(inside.sum())
        self.undecided += int(verdict.undecided.sum()) - looked_at
        self.outside += int(verdict.outside.sum()) + int((~inside).sum())


@dataclass
class Swept:
    """What one function's sweep found.

    batches  of random points that were swept, from number 0 on
    hard     points that are hard cases
    shared   table -> tables that promise the same of the function's operations
    """

    function: str
    source: str
    intervals: str
    batches: int = 0
    points: int = 0
    hard: int = 0
    seconds: float = 0.0
    shared: dict[str, list[str]] = field(default_factory=dict)
    tables: dict[str, Count] = field(default_factory=dict)
    worst: str = ""

    def entry(self) -> dict[str, Any]:
        """As data."""
        return {**asdict(self), "seconds": round(self.seconds, 1)}


def different(library: Library, name: str) -> dict[str, tuple[Table, list[str]]]:
    """Tables whose intervals of a function may differ: name -> (table, names that promise the same)."""
    used = operations(library, name)
    found: dict[Any, tuple[Table, list[str]]] = {}
    for table_name in TABLES:
        table = either_way(load_table(table_name))
        rows = [table.rows[op] for op in sorted(used)]
        key = table.flush, *((r.accuracy, str(r.magnitude), r.reciprocal, r.zero, r.normal) for r in rows)
        found.setdefault(key, (table, []))[1].append(table_name)
    return {table.name: (table, names) for table, names in found.values()}


def hard_cases(library: Library, name: str) -> Mapping[str, Any] | None:
    """All hard cases of a function together; None where it has none."""
    function = library.function(name)
    draws = []
    for family in cases.families_for(function.parameters):
        count = min(cases.coverage(function, family) or HARD, MOST_HARD)
        inputs = cases.draw(function, family, count)
        draws.append(Draw(family, count, 0, inputs))
    if cases.has_worst(function):
        worst = cases.worst(function)
        draws.append(Draw(cases.WORST, length(worst), 0, worst))
    return together(draws).inputs if draws else None


def batches(library: Library, name: str, start: int, stop: int) -> Iterator[tuple[bool, Mapping[str, Any]]]:
    """Batches of random points by their numbers, before number 0 all hard cases: (hard, inputs)."""
    hard = hard_cases(library, name) if start == 0 else None
    if hard is not None:
        yield True, hard
    for number in range(start, stop):
        yield False, cases.draw(library.function(name), cases.UNIFORM, BATCH, number + 1)


def sweep(library: Library, name: str, start: int, stop: int) -> Swept:
    """Batches start to stop of random points of one function, and hard cases, under every table."""
    begin = time.process_time()
    found = Swept(name, library.select([name]).source_hash, intervals_hash(), batches=stop - start)
    tables = different(library, name)
    for table_name, (_, names) in tables.items():
        found.shared[table_name] = names
        found.tables[table_name] = Count()
    for hard, inputs in batches(library, name, start, stop):
        count = length(inputs)
        found.points += count
        found.hard += count if hard else 0
        for first in range(0, count, PART):
            part = rows(inputs, np.arange(first, min(first + PART, count)))
            _look(library, found, part, {t: table for t, (table, _) in tables.items()})
    found.seconds = time.process_time() - begin
    return found


def _look(library: Library, found: Swept, inputs: Mapping[str, Any], tables: Mapping[str, Table]) -> None:
    """Judge some points under every table."""
    name = found.function
    value, lost = enclosed(library, name, inputs)
    allowed = {t: permitted(library, name, inputs, table) for t, table in tables.items()}
    verdicts = {t: held(a, value, lost) for t, a in allowed.items()}
    some = np.flatnonzero(np.logical_or.reduce([v.undecided for v in verdicts.values()]))[:PRECISE]
    precise = precisely(library, name, inputs, some)
    for table_name, verdict in verdicts.items():
        lanes = some[verdict.undecided[some]]
        inside = holds(allowed[table_name], some, precise)[verdict.undecided[some]]
        found.tables[table_name].add(verdict, len(lanes), inside)
        bad = [*np.flatnonzero(verdict.outside), *lanes[~inside]]
        if bad and not found.worst:
            found.worst = f"{table_name}: {cases.words(library.function(name), inputs, int(bad[0]))}"


def run(job: Job) -> dict[str, Any]:
    """A task for executors: batches job.start to job.stop of the job's function."""
    return sweep(load_library(), job.function, job.start, job.stop).entry()


@functools.cache
def intervals_hash() -> str:
    """Of everything that makes intervals: what was shown of others is stale."""
    return hash_of([INTERVALS])
