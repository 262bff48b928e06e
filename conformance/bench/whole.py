"""Errors over the base's whole domain: what `vair emit --max-error` chooses by.

The domain is what the base's signature accepts and one of its declared bounds speaks of. Elsewhere the base
itself promises nothing: its value jumps there, and float32 decides on which side an input lies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.ir.domains import Interval, Length
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.bench.accuracy import distances, reference_of, smallest_value, ulps, widened
from conformance.bench.inputs import Group, by_position, domains
from conformance.check import measure
from conformance.check.engine import Backend, draws
from conformance.check.features import applies
from conformance.guarantees.sample import together
from conformance.peers import PEERS
from conformance.reference import ambiguous

MEASURES = ("absolute", "relative", "ulp")


@dataclass(frozen=True)
class Whole:
    """One member over everything that its base accepts.

    largest     measure -> largest error found
    declared    absolute or relative -> the least that the declared bounds promise everywhere; no entry where
                they leave an input open
    non_finite  inputs with a result that is not finite
    count       inputs
    narrower    the parameters of which the member accepts less than its base; then nothing is measured
    """

    largest: dict[str, float]
    declared: dict[str, float]
    non_finite: int
    count: int
    narrower: tuple[str, ...] = ()


def whole(library: Library, group: Group, on: Backend, uniform: int, family: int) -> dict[str, Whole]:
    """The members that may stand for the base, by name: itself and its variants."""
    base = group.base
    sample = together(draws(base, uniform, family))
    clear = ~ambiguous(base.name, sample.inputs)
    promised = [applies(b, sample.inputs, sample.lanes) for b in _bounds(library, base)]
    if promised:
        clear &= np.logical_or.reduce(promised)
    truths: dict[Callable[..., Any], Any] = {}
    found = {}
    for f in group.members:
        reference = reference_of(f, base)
        if f.kind == "printed" or f.name in PEERS or reference is None:
            continue
        narrower = accepts_less(f, base)
        if narrower:
            found[f.name] = Whole({}, {}, 0, 0, narrower)
            continue
        if reference not in truths:
            truths[reference] = reference(*(widened(v) for v in sample.inputs.values()))
        truth = truths[reference]
        inputs = by_position(f, sample.inputs)
        got = on.run(library, f.name, inputs)
        bounds = library.bounds.get(f.name, [])
        largest = {name: _over(e, clear) for name, e in _errors(got, truth, bounds or _bounds(library, base))}
        found[f.name] = Whole(
            largest,
            _declared(bounds, inputs, clear, on.target),
            int((clear & ~measure.finite(got)).sum()),
            int(clear.sum()),
        )
    return found


def accepts_less(f: Function, base: Function) -> tuple[str, ...]:
    """The parameters whose domain is smaller than the base's, with the domain in words."""
    less = []
    for (path, own), theirs in zip(domains(f).items(), domains(base).values(), strict=True):
        if isinstance(own, Interval | Length) and isinstance(theirs, Interval | Length):
            if own.low > theirs.low or own.high < theirs.high:
                less.append(f"{path} {own.describe()}")
        elif isinstance(own, Interval | Length):
            less.append(f"{path} {own.describe()}")
    return tuple(less)


def _bounds(library: Library, base: Function) -> list[Bound]:
    return library.bounds.get(base.name, [])


def _errors(got: Any, truth: Any, bounds: list[Bound]) -> list[tuple[str, npt.NDArray[np.float64]]]:
    """All measures; relative errors and ULP with the floors that the bounds declare."""
    floor = max((b.floor for b in bounds if b.measure == "relative"), default=0.0)
    relative = Bound("", "relative", 0.0, "", "", floor=floor)
    smallest = min((smallest_value(b) for b in bounds), default=0.0)
    return [
        ("absolute", distances(got, truth)),
        ("relative", measure.error(relative, got, truth)),
        ("ulp", ulps(got, truth, max(smallest, 2.0**-126))),
    ]


def _over(errors: npt.NDArray[np.float64], clear: npt.NDArray[np.bool_]) -> float:
    return float(errors[clear].max()) if clear.any() else 0.0


def _declared(
    bounds: list[Bound], inputs: dict[str, Any], clear: npt.NDArray[np.bool_], target: str
) -> dict[str, float]:
    """Per measure, the largest over the inputs of the smallest bound that speaks of the input."""
    found = {}
    for name in ("absolute", "relative"):
        limits = np.full(len(clear), np.inf)
        for bound in bounds:
            exact = bound.measure == "exact"
            foreign = bound.targets and target not in bound.targets
            if (bound.measure == name or exact) and not bound.field and not foreign:
                inside = applies(bound, inputs, len(clear))
                limits[inside] = np.minimum(limits[inside], 0.0 if exact else bound.bound)
        worst = _over(limits, clear)
        if np.isfinite(worst):
            found[name] = worst
    return found
