"""One piece of a sweep: a range of places of one function on one target, judged under every bound.

Denormals: every specification lets a device read a denormal as zero, so for a denormal input the error is the
smaller of the two against f(x) and f(0); all other numbers have one truth.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.ir.nodes import Function
from codegen.library import Library, load_library
from conformance.check import measure
from conformance.check.engine import Backend, backend, expected_of, find_reference
from conformance.check.features import applies
from conformance.executor import Job
from conformance.reference import ambiguous
from conformance.sweep.positions import SMALLEST_NORMAL, positions

TASK = "conformance.sweep.task:run"
CHUNK = 1 << 20
"""Numbers per launch."""
BLOCK = 1 << 14
"""Numbers judged at a time: what numpy works on stays in the processor's cache."""
FAILURES_SHOWN = 4

_backends: dict[str, Backend] = {}


def opened(target: str) -> Backend:
    """The target's backend, opened once per process."""
    if target not in _backends:
        _backends[target] = backend(target)
    return _backends[target]


def run(job: Job) -> dict[str, Any]:
    """What the range gives: numbers checked, non-finite results, and per bound the largest error."""
    library = load_library()
    function = library.function(job.function)
    where = positions(function)
    judge = Judge(library, function, job.target)
    on = opened(job.target)
    if where is None:
        raise ValueError(f"{job.function} is not a function of one number")
    stop = min(job.stop, where.count)
    for start in range(job.start, stop, CHUNK * job.step):
        x = where.values(start, min(start + CHUNK * job.step, stop), job.step)
        got = on.run(library, job.function, {judge.parameter: x})
        for k in range(0, len(x), BLOCK):
            judge.see(x[k : k + BLOCK], got[k : k + BLOCK])
    return {"driver": on.driver, **judge.data()}


class Judge:
    """What has been seen of one function on one target."""

    def __init__(self, library: Library, function: Function, target: str) -> None:
        """Raises ValueError for a function without a reference."""
        reference = find_reference(library, function)
        if reference is None:
            raise ValueError(f"{function.name} has no reference")
        self.reference = reference
        self.name = function.name
        self.base = function.base if function.kind == "variant" else None
        self.parameter = function.parameters[0].name
        self.bounds = [b for b in library.bounds.get(self.name, ()) if not b.targets or target in b.targets]
        self.found: list[dict[str, Any]] = [
            {"measured": -1.0, "worst": "", "lanes": 0, "failures": 0, "failed": []} for _ in self.bounds
        ]
        self.lanes = self.denormal = self.non_finite = 0
        self.not_finite: list[str] = []

    def see(self, x: npt.NDArray[Any], got: npt.NDArray[Any]) -> None:
        """Judge the results of a block of numbers."""
        inputs = {self.parameter: x}
        self.lanes += len(x)
        with np.errstate(all="ignore"):
            expected = expected_of(self.reference, inputs)
            denormal, flushed = np.zeros(len(x), np.bool_), None
            if x.dtype == np.float32:
                denormal = (x != 0) & (np.abs(x) < np.float32(SMALLEST_NORMAL))
                if denormal.any():
                    self.denormal += int(denormal.sum())
                    flushed = expected_of(self.reference, {self.parameter: np.where(denormal, 0, x)})
            usable = measure.finite(got)
            if not usable.all():
                self.non_finite += int((~usable).sum())
                self.not_finite += hexes(x[~usable])[: FAILURES_SHOWN - len(self.not_finite)]
            usable &= ~ambiguous(self.name, inputs, self.base)
            for bound, entry in zip(self.bounds, self.found, strict=True):
                inside = usable & applies(bound, inputs, len(x)) if bound.where else usable
                error = measure.error(bound, got, expected)
                if flushed is not None:
                    other = measure.error(bound, got, flushed)
                    error = np.where(denormal, np.minimum(error, other), error)
                note(entry, bound, x, error, inside)

    def data(self) -> dict[str, Any]:
        """Plain data for the record."""
        bounds = [
            {"bound": b.describe(), "limit": b.bound, **e}
            for b, e in zip(self.bounds, self.found, strict=True)
        ]
        return {
            "lanes": self.lanes,
            "denormal": self.denormal,
            "non_finite": self.non_finite,
            "not_finite": self.not_finite,
            "bounds": bounds,
        }


def note(
    entry: dict[str, Any],
    bound: Bound,
    x: npt.NDArray[Any],
    error: npt.NDArray[np.float64],
    inside: npt.NDArray[np.bool_],
) -> None:
    """Add a chunk's errors to what a bound has seen."""
    marks = np.where(inside, error, -1.0)
    lane = int(np.argmax(marks))
    entry["lanes"] += int(inside.sum())
    if marks[lane] > entry["measured"]:
        entry["measured"], entry["worst"] = float(marks[lane]), hexes(x[lane : lane + 1])[0]
    if not marks[lane] > bound.bound:
        return
    failed = np.flatnonzero(marks > bound.bound)
    entry["failures"] += len(failed)
    entry["failed"] += hexes(x[failed[:FAILURES_SHOWN]])[: FAILURES_SHOWN - len(entry["failed"])]


def hexes(x: npt.NDArray[Any]) -> list[str]:
    """The words of the first numbers."""
    return [f"{word:08x}" for word in np.ascontiguousarray(x[:FAILURES_SHOWN]).view(np.uint32)]
