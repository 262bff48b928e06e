"""Runs pairs on targets and judges them by the intervals of both sides."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Array, Value
from codegen.intervals import Permitted
from codegen.library import Library
from conformance.check.show import lane_inputs
from conformance.metamorphic.pairs import Pair, columns
from conformance.programs import batch, judge, rearranged
from targets import Runtime

BATCH = 12
"""Pairs compiled together."""


@dataclass
class Count:
    """What became of a relation's pairs of results, one pair for each lane and target."""

    pairs: int = 0
    open: int = 0
    rearranged: int = 0
    equal: int = 0
    failed: int = 0


@dataclass
class Report:
    """Counts per relation, and failures in words."""

    counts: dict[str, Count] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)

    @property
    def pairs(self) -> int:
        return sum(c.pairs for c in self.counts.values())

    def lines(self) -> list[str]:
        """A table: relation, pairs, unbounded, explained by rearrangement, equal to the bit, failed."""
        lines = [
            f"{'relation':28} {'pairs':>9} {'unbounded':>9} {'rearranged':>10} {'equal':>7} {'failed':>7}"
        ]
        for name, c in self.counts.items():
            share = c.equal / max(c.pairs, 1)
            lines.append(f"{name:28} {c.pairs:9} {c.open:9} {c.rearranged:10} {share:7.1%} {c.failed:7}")
        return [*lines, f"{'all':28} {self.pairs:9}"]


def run_pairs(library: Library, pairs: Iterable[Pair], runtimes: Sequence[Runtime], lanes: int) -> Report:
    """Run every pair on every target."""
    report = Report()
    waiting = list(pairs)
    for start in range(0, len(waiting), BATCH):
        part = waiting[start : start + BATCH]
        extended = library.with_functions(f for pair in part for f in pair.added)
        for pair in part:
            _check_meaning(report, extended, pair)
        for runtime in runtimes:
            jobs = [job for pair in part for job in (pair.first, pair.second)]
            values = batch.run(extended, jobs, runtime, lanes)
            for pair, a, b in zip(part, values[::2], values[1::2], strict=True):
                _judge(report, extended, pair, runtime.device.target, a, b)
    return report


def _check_meaning(report: Report, library: Library, pair: Pair) -> None:
    """Both sides in float64: the relation itself, whatever a target does."""
    a = evaluate(library, pair.first.name, pair.first.inputs, "float64")
    b = evaluate(library, pair.second.name, pair.second.inputs, "float64")
    a, _ = pair.result(library.function(pair.first.name), (a, a))
    bad = np.zeros(1, np.bool_)
    with np.errstate(invalid="ignore", over="ignore"):
        for x, y in zip(columns(a), columns(b), strict=True):
            near = np.abs(x.astype(np.float64) - y) <= pair.tolerance * (1.0 + np.abs(x.astype(np.float64)))
            both_odd = ~np.isfinite(x.astype(np.float64)) & ~np.isfinite(y.astype(np.float64))
            wrong = ~(near | both_odd)
            bad = bad | (wrong.any(axis=-1) if wrong.ndim == 2 else wrong)
    if bad.any():
        _fail(report, pair, "float64", int(np.argmax(bad)), "the two sides mean different numbers", a, b)


def _judge(report: Report, library: Library, pair: Pair, target: str, a: Value, b: Value) -> None:
    function = library.function(pair.first.name)
    first = judge.intervals(library, pair.first.name, pair.first.inputs, target)
    second = judge.intervals(library, pair.second.name, pair.second.inputs, target)
    wrong = np.zeros(len(first.codes), np.bool_)
    moved = wrong
    for job, allowed, value in ((pair.first, first, a), (pair.second, second, b)):
        outside = judge.judge(allowed, value).wrong
        if outside.any():
            why = outside & rearranged.explained(library, job.name, job.inputs, target, value)
            outside, moved = outside & ~why, moved | why
        wrong = wrong | outside
    low, high = pair.result(function, (first.low, first.high))
    first = Permitted(low, high, first.codes, first.causes)
    a, _ = pair.result(function, (a, a))
    open_ = ~(first.guaranteed & second.guaranteed)
    apart = ~open_ & ~moved & ~judge.distance_within(first, second, a, b)
    disjoint = ~open_ & ~_meet(first, second) if pair.is_exact else np.zeros_like(open_)
    count = report.counts.setdefault(pair.relation, Count())
    count.pairs += len(wrong)
    count.open += int(open_.sum())
    count.rearranged += int(moved.sum())
    count.equal += int(judge.equal(a, b).sum())
    for mask, what in (
        (wrong, "a result is outside its own interval"),
        (apart, "the results differ by more than both intervals"),
        (disjoint, "the two intervals do not meet, though both contain the exact result"),
    ):
        if mask.any():
            count.failed += int(mask.sum())
            _fail(report, pair, target, int(np.argmax(mask)), what, a, b, (first, second))


def _meet(first: Permitted, second: Permitted) -> Array:
    """Mask of the lanes in which two results may be equal."""
    meets = [
        (np.maximum(a, c) <= np.minimum(b, d)).reshape(len(first.codes), -1).all(axis=1)
        for a, b, c, d in zip(*map(columns, (first.low, first.high, second.low, second.high)), strict=True)
    ]
    return np.asarray(np.logical_and.reduce(meets))


def _fail(
    report: Report,
    pair: Pair,
    target: str,
    lane: int,
    what: str,
    a: Value,
    b: Value,
    allowed: tuple[Permitted, ...] = (),
) -> None:
    count = len(next(iter(columns(a))))
    lines = [
        f"{pair.relation} of {pair.subject} on {target}, lane {lane}: {what}",
        f"  first   {_at(a, lane)} for {lane_inputs(dict(pair.first.inputs), lane)}",
        f"  second  {_at(b, lane)} for {lane_inputs(dict(pair.second.inputs), lane)} ({count} lanes)",
    ]
    lines += [f"  permitted {_at(p.low, lane)} to {_at(p.high, lane)}" for p in allowed]
    report.failures.append("\n".join(lines))


def _at(value: Any, lane: int) -> Any:
    if isinstance(value, dict):
        return {name: _at(v, lane) for name, v in value.items()}
    return value[lane]
