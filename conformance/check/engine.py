"""Checking one function on one backend: every result is judged twice, and its accuracy told beside.

  permitted     inside the interval that the target's accuracy table allows the function to return
  within bound  within every declared bound whose domain holds the input, against the float64 reference
Finite input gives a finite result, always.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.library import Library
from conformance.check import accuracy, interval, measure, show
from conformance.check.backend import Backend, backend
from conformance.check.describe import describe
from conformance.check.draws import FAMILY_COUNT, SEED, UNIFORM_COUNT, Draw, draw, draws, only_lane
from conformance.check.failure import FINITE, PERMITTED, WITHIN, Missed
from conformance.check.features import applies
from conformance.check.prepared import Prepared, expected_of, find_reference, has_reference, prepare
from conformance.check.result import BoundResult, FunctionResult

__all__ = [
    "FAMILY_COUNT",
    "MAX_FAILURES",
    "SEED",
    "UNIFORM_COUNT",
    "Backend",
    "Draw",
    "backend",
    "check_function",
    "draw",
    "draws",
    "expected_of",
    "find_reference",
    "only_lane",
]

MAX_FAILURES = 5
"""Failures reported in full per function and backend; all are counted."""

Mask = npt.NDArray[np.bool_]
Doubles = npt.NDArray[np.float64]


def check_function(
    library: Library,
    name: str,
    on: Backend,
    draws_of: Iterable[Draw] | None = None,
    *,
    prepared: Prepared | None = None,
    intervals: bool = True,
) -> FunctionResult:
    """Check one function.

    draws_of   the inputs; those of a full check if None
    prepared   the same with all that no device gives, where several backends share it
    intervals  False leaves out the verdict "permitted", where a library is tried that has none of its own
    """
    result = FunctionResult(name, on.target, on.driver, backend=on.name or on.target)
    result.source = library.select([name]).source_hash
    text = on.text(library, name) if on.text is not None else ""
    result.emitted = hashlib.sha256(text.encode()).hexdigest()[:16] if text else ""
    bounds = [b for b in library.bounds.get(name, ()) if not b.targets or on.target in b.targets]
    started = time.perf_counter()
    if not bounds:
        result.broken = f"{name} declares no error bound for {on.target}"
        return result
    if not has_reference(library, name):
        result.broken = f"{name} has no reference"
        return result
    ready = prepared or prepare(library, name, draws_of)
    got = on.run(library, name, ready.sample.inputs)
    _judge(result, ready, bounds, got, on, intervals)
    result.program = text if result.failures else ""
    result.seconds = time.perf_counter() - started
    return result


@dataclass
class _BoundVerdict:
    """Lane by lane: where a bound judges (nothing infinite or exempt), the error, where it is missed."""

    bound: Bound
    inside: Mask
    error: Doubles
    missed: Mask

    @property
    def beyond(self) -> Doubles:
        """The error over the bound where it is missed, 0 elsewhere."""
        with np.errstate(over="ignore"):
            return np.where(self.missed, self.error / (self.bound.bound or 1.0), 0.0)


def _judge(
    result: FunctionResult, ready: Prepared, bounds: list[Bound], got: Any, on: Backend, intervals: bool
) -> None:
    truth, count = ready.truth, ready.sample.lanes
    finite = measure.finite(got)
    result.lanes, result.non_finite = count, int((~finite).sum())
    result.ambiguous = int(truth.doubtful.sum())
    verdicts = _bounds(result, ready, bounds, got, finite)
    use = np.logical_or.reduce([v.inside for v in verdicts])
    result.accuracy = accuracy.measured(ready.function, ready.sample, got, truth.expected, use)
    outside, excess = np.zeros(count, np.bool_), np.zeros(count)
    if intervals:
        allowed = ready.permitted(on.judged_by)
        judged = interval.judge(ready.library, ready.name, ready.sample, got, allowed, on)
        result.permitted, outside, excess = judged.result, judged.outside, judged.excess
    missed = np.logical_or.reduce([v.missed for v in verdicts])
    bad = np.flatnonzero(~finite | outside | missed)
    if not len(bad):
        return
    # What is not finite first, then what misses a bound, by how much; then what is only outside.
    beyond = np.max([v.beyond for v in verdicts], axis=0)
    order = np.lexsort((-excess[bad], -beyond[bad], finite[bad]))
    for lane in map(int, bad[order][:MAX_FAILURES]):
        states = {FINITE: not finite[lane], PERMITTED: outside[lane], WITHIN: missed[lane]}
        failed = tuple(name for name, is_bad in states.items() if is_bad)
        told = tuple(_missed(v, lane) for v in verdicts if v.missed[lane])
        result.failures.append(
            describe(ready, on, lane, failed, got, told, float(excess[lane]) if intervals else None)
        )


def _bounds(
    result: FunctionResult, ready: Prepared, bounds: list[Bound], got: Any, finite: Mask
) -> list[_BoundVerdict]:
    truth, inputs, count = ready.truth, ready.sample.inputs, ready.sample.lanes
    covered = truth.doubtful.copy()
    verdicts = []
    for bound in bounds:
        found = BoundResult(bound.describe(), bound.bound)
        inside = applies(bound, inputs, count)
        covered |= inside
        inside &= finite & ~truth.doubtful
        error = np.zeros(count)
        if inside.any():
            error = measure.error(bound, got, truth.expected)
            _summarise(found, error[inside])
            found.worst = show.lane_inputs(inputs, int(np.argmax(np.where(inside, error, -1.0))))
        missed = inside & ~(error <= bound.bound)
        found.failures = int(missed.sum())
        result.bounds.append(found)
        verdicts.append(_BoundVerdict(bound, inside, error, missed))
    result.uncovered = int((~covered).sum())
    return verdicts


def _summarise(found: BoundResult, errors: Doubles) -> None:
    found.lanes, found.measured = len(errors), float(errors.max())
    # One of the errors, not a value between two of them: infinite ones have no difference.
    found.p999 = float(np.quantile(errors, 0.999, method="higher"))
    found.median = float(np.median(errors))


def _missed(v: _BoundVerdict, lane: int) -> Missed:
    error = f"{v.bound.measure} {v.error[lane]:.4g} exceeds {v.bound.bound:.4g}"
    return Missed(error, v.bound.describe(), v.bound.origin)
