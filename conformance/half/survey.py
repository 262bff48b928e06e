"""One function in half precision: emulated on random points and hard cases, over the mildest useful range."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.half import declared_constants
from codegen.ir.domains import Interval, Unit
from codegen.ir.nodes import Function
from codegen.ir.types import F32, Struct, Type, element_of, leaves
from codegen.library import Library
from codegen.passes.half import HalfRules
from conformance.check import measure
from conformance.check.engine import SEED, draw, draws, expected_of, find_reference
from conformance.check.features import feature
from conformance.guarantees.sample import rows, together
from conformance.half.restrictions import Where, narrowed, restrictions
from conformance.reference import ambiguous

LIMIT = 1.0 / 255.0
"""Largest error of a half form that is of use: one step of an 8-bit channel, of 1 or of the value."""
FLOORS = (2.0**-12, 2.0**-10, 2.0**-8, 2.0**-6)
"""Values below count as this large where a relative error is judged; the smallest that will do is chosen."""
UNIFORM_COUNT, FAMILY_COUNT, CONFIRM_COUNT = 6000, 500, 20_000
FEWEST = 100
"""Fewest points in a range that is judged at all."""
MOST_SAMPLES = 12
"""Most draws for one function."""
ARITHMETICS = ("float16", "float16-strict")
SINGLE_PENALTY = 1.5


@dataclass(frozen=True)
class Found:
    """What the survey says of a function: a range with an error, or why there is none.

    worst  largest error over the whole domain in the mildest measure, for the sentence that refuses it
    """

    single: tuple[str, ...]
    where: Mapping[str, tuple[float, float]]
    measure: str
    floor: float
    error: float
    lanes: int
    refused: str = ""


@dataclass(frozen=True)
class Sample:
    """Inputs of a function as halves (single ones apart) with the reference's results."""

    inputs: dict[str, Any]
    truth: Any
    count: int
    known: dict[str, npt.NDArray[Any]] = field(default_factory=dict)

    def inside(self, where: Where) -> npt.NDArray[np.bool_]:
        """Mask of the lanes with every feature in its interval."""
        mask = np.ones(self.count, np.bool_)
        for text, (low, high) in where.items():
            if text not in self.known:
                self.known[text] = feature(self.inputs, text)
            mask &= (self.known[text] >= low) & (self.known[text] <= high)
        return mask


def survey(library: Library, name: str) -> Found:
    """The mildest restriction under which the half form errs by at most LIMIT."""
    function = library.function(name)
    if not _has_floats(function):
        return _refused("it has no floating-point numbers")
    if find_reference(library, function) is None:
        return _refused("it has no reference to be measured against")
    units = tuple(p.name for p in function.parameters if isinstance(p.domain, Unit))
    halves = [p for p in function.parameters if p.name not in units and _floats(p.type)]
    ways = restrictions(function)
    best: tuple[float, Found] | None = None
    least = np.inf
    for single in [(), *([units] if units and halves else [])]:
        try:
            trial = Trial(library, function, single)
            trial.add(ways[-1].where)
        except UserError as e:
            return _refused(str(e))
        for floor, extra in judged(library, name):
            for way in ways:
                penalty = way.penalty + extra + (SINGLE_PENALTY if single else 0.0)
                if best is not None and penalty >= best[0]:
                    break
                if trial.lanes(way.where) < FEWEST and len(trial.samples) < MOST_SAMPLES:
                    trial.add(way.where)
                if trial.lanes(way.where) >= FEWEST and trial.worst(way.where, floor) <= LIMIT:
                    trial.add(way.where)
                    if trial.worst(way.where, floor) <= LIMIT:
                        best = penalty, _found(trial, way.where, floor)
                        break
            least = min(least, trial.worst(ways[-1].where, floor))
    if best is None:
        if not np.isfinite(least):
            return _refused("its results overflow or are no numbers")
        if least <= LIMIT:
            return _refused("no range of its domain is held by enough halves")
        return _refused(f"it errs by {least:.2g} even in a narrow range, and {LIMIT:.2g} is allowed")
    return best[1]


class Trial:
    """A function's half form with some parameters kept in f32, run on more and more inputs."""

    def __init__(self, library: Library, function: Function, single: tuple[str, ...]) -> None:
        self.library, self.function, self.single = library, function, single
        self.samples: list[Sample] = []
        self._results: list[list[Any]] = []
        self._errors: dict[tuple[int, float], npt.NDArray[np.float64]] = {}
        self.add(None)

    def add(self, where: Where | None) -> None:
        """Run more inputs: from the whole domain, or random points from a range."""
        sample = half_sample(self.library, self.function, self.single, where)
        rules = rules_with(self.library, self.function.name, self.single)
        self.samples.append(sample)
        self._results.append(
            [evaluate(self.library, self.function.name, sample.inputs, a, rules=rules) for a in ARITHMETICS]
        )

    def errors(self, k: int, floor: float) -> npt.NDArray[np.float64]:
        """The larger error of both emulations per lane of a sample, relative to the value or the floor."""
        if (k, floor) not in self._errors:
            bound = Bound(self.function.name, "relative", 0.0, "", "", floor=floor)
            truth = self.samples[k].truth
            with np.errstate(all="ignore"):
                found = np.maximum.reduce([measure.error(bound, got, truth) for got in self._results[k]])
            self._errors[k, floor] = found
        return self._errors[k, floor]

    def worst(self, where: Where, floor: float) -> float:
        """The largest error inside a range."""
        parts = [self.errors(k, floor)[s.inside(where)] for k, s in enumerate(self.samples)]
        return max(float(part.max(initial=0.0)) for part in parts)

    def lanes(self, where: Where) -> int:
        """How many inputs lie inside a range."""
        return sum(int(s.inside(where).sum()) for s in self.samples)

    def at_most_one(self, where: Where) -> bool:
        """Whether no value inside a range exceeds 1."""
        return all(
            float(np.abs(a[s.inside(where)]).max(initial=0.0)) <= 1.0 + 1e-6
            for s in self.samples
            for _, a in measure.fields(s.truth)
        )


def _found(trial: Trial, where: Where, floor: float) -> Found:
    """The finding, without angles that make no difference."""
    for text in [key for key in where if key.startswith("angle")]:
        fewer = {key: value for key, value in where.items() if key != text}
        if trial.worst(fewer, floor) <= LIMIT:
            where = fewer
    absolute = floor == 1.0 and trial.at_most_one(where)
    kind, shown = ("absolute", 0.0) if absolute else ("relative", floor)
    return Found(trial.single, where, kind, shown, trial.worst(where, floor), trial.lanes(where))


def _refused(why: str) -> Found:
    return Found((), {}, "", 0.0, 0.0, 0, why)


def _floats(type_: Type) -> bool:
    return any(scalar == F32 for _, scalar in leaves(type_))


def _has_floats(function: Function) -> bool:
    return _floats(function.returns) or any(_floats(p.type) for p in function.parameters)


def judged(library: Library, name: str) -> list[tuple[float, float]]:
    """Floors under which the error is judged, each with its penalty; 1.0 stands for an absolute error."""
    measures = {b.measure for b in library.bounds.get(name, ())}
    found = [(floor, 0.3 * k) for k, floor in enumerate(FLOORS)] if "relative" in measures else []
    return [*found, (1.0, 1.3 if found else 0.0)] if measures != {"relative"} else found


def rounded(type_: Type, value: Any) -> Any:
    """The value with every float rounded to half, kept as float32."""
    if isinstance(type_, Struct):
        return {f.name: rounded(f.type, value[f.name]) for f in type_.fields}
    if element_of(type_) != F32:
        return value
    with np.errstate(over="ignore"):
        return np.asarray(value).astype(np.float16).astype(np.float32)


def half_sample(
    library: Library,
    function: Function,
    single: tuple[str, ...],
    where: Mapping[str, tuple[float, float]] | None = None,
) -> Sample:
    """Random points and hard cases of the domain, rounded; what leaves the domain by rounding is left out.

    where  draw random points from these intervals only
    """
    reference = find_reference(library, function)
    assert reference is not None
    if where is None:
        near = draw(narrowed(function), "uniform", UNIFORM_COUNT, SEED)
        drawn = together([*draws(function, UNIFORM_COUNT, FAMILY_COUNT), near])
    else:
        drawn = together([draw(narrowed(function, dict(where)), "uniform", CONFIRM_COUNT, SEED + 1)])
    inputs = {
        p.name: drawn.inputs[p.name] if p.name in single else rounded(p.type, drawn.inputs[p.name])
        for p in function.parameters
    }
    keep = np.ones(drawn.lanes, np.bool_)
    for p in function.parameters:
        keep &= _allowed(p.type, p.domain, inputs[p.name], drawn.inputs[p.name])
    inputs = rows(inputs, np.flatnonzero(keep))
    base = function.base if function.kind == "variant" else None
    doubtful = ambiguous(function.name, inputs, base)
    inputs = rows(inputs, np.flatnonzero(~doubtful))
    with np.errstate(all="ignore"):
        truth = expected_of(reference, inputs)
    return Sample(inputs, truth, int((~doubtful).sum()))


def _allowed(type_: Type, domain: Any, value: Any, given: Any) -> npt.NDArray[np.bool_]:
    """Mask of the lanes that rounding left inside the domain, and did not move to its upper end."""
    if isinstance(type_, Struct):
        masks = [_allowed(f.type, f.domain, value[f.name], given[f.name]) for f in type_.fields]
        return np.asarray(functools.reduce(np.logical_and, masks))
    a = np.asarray(value)
    ok = np.isfinite(a) if a.dtype.kind == "f" else np.ones(a.shape, np.bool_)
    if isinstance(domain, Interval):
        ok &= (a >= domain.low) & (a <= domain.high) & ((a < domain.high) | (a == given))
    return np.asarray(ok.all(axis=-1) if ok.ndim == 2 else ok)


def rules_with(library: Library, name: str, single: tuple[str, ...]) -> HalfRules:
    """The declared rules with these parameters kept in f32."""
    return HalfRules(declared_constants(library), {name: frozenset(single)})
