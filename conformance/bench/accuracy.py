"""The error that stands beside a speed: every member of a group on the same inputs, in the same measure.

The inputs are uniform and hard ones from the ranges of parameters that all members accept and for which they
declare a bound; the measure is that of the base's. Where directions come close to each other a variant may be
far off its base, and that is what the figure shows. A printed form is held against the printed formula.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.bench.inputs import Group, by_position, declared, domains
from conformance.check import measure
from conformance.check.engine import Backend, draws
from conformance.check.features import applies
from conformance.reference import ambiguous, reference_for

Errors = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Error:
    """What one member is off on one driver.

    measure       absolute, relative or exact
    largest       largest error found, a lower bound of the true one
    p999, median  quantiles over all inputs
    non_finite    inputs with a result that is not finite
    count         inputs
    """

    measure: str
    largest: float
    p999: float
    median: float
    non_finite: int
    count: int


def errors(
    library: Library, group: Group, on: Backend, uniform: int, family: int
) -> tuple[str, dict[str, Error]]:
    """The errors of all members by name, and the domain in words.

    uniform, family  number of random inputs, and most inputs of each hard family
    returns          no entry for a member without a reference; nothing where the base has no bound
    """
    inside, bound = declared(library, group)
    if bound is None:
        return "", {}
    judge = replace(bound, field="")
    parts: dict[str, list[Errors]] = {}
    for d in draws(inside, uniform, family):
        chosen = applies(bound, d.inputs, d.count) & ~ambiguous(group.base.name, d.inputs)
        if not chosen.any():
            continue
        expected: dict[Callable[..., Any], Any] = {}
        for f in group.members:
            reference = _reference(f, group.base)
            if reference is None:
                continue
            if reference not in expected:
                expected[reference] = reference(*(widened(v) for v in d.inputs.values()))
            got = on.run(library, f.name, by_position(f, d.inputs))
            parts.setdefault(f.name, []).append(measure.error(judge, got, expected[reference])[chosen])
    found = {name: _summary(bound.measure, np.concatenate(e)) for name, e in parts.items()}
    return _in_words(bound, group.base, inside), found


def _in_words(bound: Bound, base: Function, cut: Function) -> str:
    """The bound's domain, and where the members together allow less than the base's signature."""
    whole = domains(base)
    less = [
        f"{path} {d.describe()}" for path, d in domains(cut).items() if d is not None and d != whole[path]
    ]
    return "; ".join([bound.domain, *less])


def _reference(f: Function, base: Function) -> Callable[..., Any] | None:
    """The function's own reference, or that of what it varies; a printed form has only its own."""
    for name in (f.name, f.base or f.name, base.name) if f.kind != "printed" else (f.name,):
        try:
            return reference_for(name)
        except KeyError:
            continue
    return None


def widened(value: Any) -> Any:
    """The exact float64 values of float32 inputs, for a reference."""
    if isinstance(value, Mapping):
        return {name: widened(v) for name, v in value.items()}
    a = np.asarray(value)
    return a.astype(np.float64) if a.dtype == np.float32 else a


def _summary(name: str, found: Errors) -> Error:
    good = found[np.isfinite(found)]
    bad = len(found) - len(good)
    if not len(good):
        return Error(name, float("inf"), float("inf"), float("inf"), bad, len(found))
    p999, median = np.quantile(good, (0.999, 0.5))
    return Error(name, float(good.max()), float(p999), float(median), bad, len(found))
