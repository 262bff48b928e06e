"""The verdict on a range of numbers that lie in order, for one function on one target.

Most blocks of numbers hold nothing new: no denormal, no end of a bound's domain, no error above the largest
one so far. One pass of arithmetic shows that; only the other blocks are looked at number by number.

Denormals: every specification lets a device read a denormal as zero, so for a denormal input the error is the
smaller of the two against f(x) and f(0); all other numbers have one truth.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.check import engine, measure
from conformance.check.engine import find_reference
from conformance.check.features import applies
from conformance.reference import PREDICATES, ambiguous
from conformance.sweep.positions import SMALLEST_NORMAL

FAILURES_SHOWN = 4

Array = npt.NDArray[Any]
Reals = npt.NDArray[np.float64]


def reference_of(library: Library, function: Function) -> Callable[..., Any]:
    """The function's reference; ValueError where it has none."""
    reference = find_reference(library, function)
    if reference is None:
        raise ValueError(f"{function.name} has no reference")
    return reference


class Block:
    """Numbers in ascending order with their true values, and what every target's judge needs of both."""

    def __init__(self, reference: Callable[..., Any], parameter: str, x: Array) -> None:
        self.x = x
        self.reference = reference
        self.parameter = parameter
        self.ends = float(x[0]), float(x[-1])
        with np.errstate(all="ignore"):
            self.expected: Array = engine.expected_of(reference, {parameter: x})
        low, high = self.ends
        self.near_zero = x.dtype == np.float32 and low < SMALLEST_NORMAL and high > -SMALLEST_NORMAL
        self._scales: dict[float, Reals] = {}
        self._cast: Array | None = None

    def scale(self, floor: float) -> Reals:
        """What a relative error is relative to."""
        if floor not in self._scales:
            self._scales[floor] = np.maximum(np.abs(self.expected), floor)
        return self._scales[floor]

    def exact(self, dtype: Any) -> Array:
        """The true values as the type that a target returns."""
        if self._cast is None or self._cast.dtype != dtype:
            self._cast = self.expected.astype(dtype)
        return self._cast

    def within(self, bound: Bound) -> bool:
        """Whether all of the block lies in the bound's domain; False also where that takes a closer look."""
        if not bound.where:
            return True
        if list(bound.where) != [self.parameter]:
            return False
        low, high = bound.where[self.parameter]
        return low <= self.ends[0] and self.ends[1] <= high

    def outside(self, bound: Bound) -> bool:
        """Whether none of the block lies in the bound's domain; False also where that takes a closer look."""
        if list(bound.where) != [self.parameter]:
            return False
        low, high = bound.where[self.parameter]
        return self.ends[1] < low or high < self.ends[0]


class Judge:
    """What has been seen of one function on one target."""

    def __init__(self, library: Library, function: Function, target: str) -> None:
        self.name = function.name
        self.base = function.base if function.kind == "variant" else None
        self.doubtful = self.name in PREDICATES or self.base in PREDICATES
        self.bounds = [b for b in library.bounds.get(self.name, ()) if not b.targets or target in b.targets]
        self.found: list[dict[str, Any]] = [
            {"measured": -1.0, "worst": "", "lanes": 0, "failures": 0, "failed": []} for _ in self.bounds
        ]
        self.lanes = self.denormal = self.non_finite = 0
        self.not_finite: list[str] = []

    def see(self, block: Block, got: Array) -> None:
        """Judge the results of a block of numbers."""
        if not self._nothing_new(block, got):
            self._look(block, got)

    def _nothing_new(self, block: Block, got: Array) -> bool:
        """Whether no error of the block is a miss or exceeds what was found, and nothing else needs a look.

        If so, the block is counted.

        A result that is not finite makes the largest error infinite or NaN, which is never "no larger".
        """
        if block.near_zero or self.doubtful or not self.bounds:
            return False
        inside = []
        for bound, entry in zip(self.bounds, self.found, strict=True):
            if block.outside(bound):
                continue
            known = min(entry["measured"], bound.bound)
            if not block.within(bound) or not largest(bound, block, got) <= known:
                return False
            inside.append(entry)
        if not inside and not measure.finite(got).all():
            return False
        for entry in inside:
            entry["lanes"] += len(block.x)
        self.lanes += len(block.x)
        return True

    def _look(self, block: Block, got: Array) -> None:
        """Judge number by number."""
        x, expected = block.x, block.expected
        inputs = {block.parameter: x}
        self.lanes += len(x)
        with np.errstate(all="ignore"):
            denormal, flushed = np.zeros(len(x), np.bool_), None
            if x.dtype == np.float32:
                denormal = (x != 0) & (np.abs(x) < np.float32(SMALLEST_NORMAL))
                if denormal.any():
                    self.denormal += int(denormal.sum())
                    flushed = engine.expected_of(block.reference, {block.parameter: np.where(denormal, 0, x)})
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


def largest(bound: Bound, block: Block, got: Array) -> float:
    """The largest error of a block in the bound's measure; NaN or infinite where a result is not finite."""
    if bound.measure == "exact":
        return 0.0 if np.array_equal(got, block.exact(got.dtype)) else np.inf
    with np.errstate(all="ignore"):
        error = np.subtract(got, block.expected, dtype=np.float64)
        np.abs(error, out=error)
        if bound.measure == "relative":
            np.divide(error, block.scale(bound.floor or 0.0), out=error)
        return float(error.max())


def note(
    entry: dict[str, Any],
    bound: Bound,
    x: Array,
    error: Reals,
    inside: npt.NDArray[np.bool_],
) -> None:
    """Add a block's errors to what a bound has seen."""
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


def hexes(x: Array) -> list[str]:
    """The words of the first numbers."""
    return [f"{word:08x}" for word in np.ascontiguousarray(x[:FAILURES_SHOWN]).view(np.uint32)]
