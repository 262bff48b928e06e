"""The error that stands beside a speed: every member of a group on the same inputs, in the same measures.

The inputs are uniform and hard ones from the ranges of parameters that all members accept and for which they
declare a bound. Where directions come close to each other a variant may be far off its base, and that is what
the figures show. A printed form is held against the printed formula. What the target's specification permits
is evaluated on the same inputs. For choosing a variant, whole.py measures the base's whole domain.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance import cases
from conformance.bench.inputs import Group, by_position, declared, domains
from conformance.check import measure
from conformance.check.engine import Backend, draws
from conformance.check.features import applies
from conformance.guarantees.sample import Sample, rows, together
from conformance.reference import ambiguous, reference_for

Errors = npt.NDArray[np.float64]

STEPS = 255.0
"""Steps of an 8-bit channel between 0 and 1."""
SMALLEST_ABSOLUTE = 2.0**-24
"""Where a function promises an absolute error, ULP are those of values no smaller than this."""
SMALLEST_NORMAL = 2.0**-126
LARGEST_SINGLE = 2.0**127
PERMITTED_LANES = 4000
"""Most inputs on which the specification is evaluated; the worst measured ones are among them."""


@dataclass(frozen=True)
class Largest:
    """Errors in one unit: the largest with its input as words in hex, and the 99.9 % quantile."""

    largest: float
    p999: float
    words: str


@dataclass(frozen=True)
class Permitted:
    """The largest error that a specification permits on the same inputs.

    guaranteed  share of the inputs whose result it bounds; the errors speak of these alone
    """

    table: str
    ulp: float
    steps: float
    guaranteed: float


@dataclass(frozen=True)
class Error:
    """What one member is off on one driver.

    measure       absolute, relative or exact: that of the base's bound
    largest       largest error found in it, a lower bound of the true one
    p999, median  quantiles over all inputs
    non_finite    inputs with a result that is not finite
    count         inputs
    ulp, steps    the same errors in units of float32's spacing, and in steps of an 8-bit channel
    """

    measure: str
    largest: float
    p999: float
    median: float
    non_finite: int
    count: int
    ulp: Largest
    steps: Largest
    permitted: Permitted | None


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
    sample = together(draws(inside, uniform, family))
    chosen = applies(bound, sample.inputs, sample.lanes) & ~ambiguous(group.base.name, sample.inputs)
    truths: dict[Callable[..., Any], Any] = {}
    found = {}
    for f in group.members:
        reference = reference_of(f, group.base)
        if reference is None or not chosen.any():
            continue
        if reference not in truths:
            truths[reference] = reference(*(widened(v) for v in sample.inputs.values()))
        found[f.name] = _error(library, f, bound, sample, truths[reference], chosen, on)
    return _in_words(bound, group.base, inside), found


def _error(
    library: Library,
    f: Function,
    bound: Bound,
    sample: Sample,
    truth: Any,
    chosen: npt.NDArray[np.bool_],
    on: Backend,
) -> Error:
    """One member's errors on the chosen lanes of the sample."""
    inputs = by_position(f, sample.inputs)
    got = on.run(library, f.name, inputs)
    finite = measure.finite(got)
    own = measure.error(replace(bound, field=""), got, truth)
    smallest = smallest_value(bound)
    ulp, steps = ulps(got, truth, smallest), STEPS * distances(got, truth)
    good = chosen & finite
    if not good.any():
        nothing = Largest(float("inf"), float("inf"), "")
        count, inf = int(chosen.sum()), float("inf")
        return Error(bound.measure, inf, inf, inf, count, count, nothing, nothing, None)
    p999, median = np.quantile(own[good], (0.999, 0.5), method="higher")
    lanes = [int(np.argmax(np.where(good, e, -1.0))) for e in (ulp, steps)]
    return Error(
        measure=bound.measure,
        largest=float(own[good].max()),
        p999=float(p999),
        median=float(median),
        non_finite=int((chosen & ~finite).sum()),
        count=int(chosen.sum()),
        ulp=_largest(f, inputs, ulp, good, lanes[0]),
        steps=_largest(f, inputs, steps, good, lanes[1]),
        permitted=_permitted(library, f, inputs, truth, chosen, lanes, smallest, on.target),
    )


def _largest(
    f: Function, inputs: Mapping[str, Any], found: Errors, good: npt.NDArray[np.bool_], lane: int
) -> Largest:
    quantile = float(np.quantile(found[good], 0.999, method="higher"))
    return Largest(float(found[lane]), quantile, cases.found.words(f, inputs, lane))


def _permitted(
    library: Library,
    f: Function,
    inputs: Mapping[str, Any],
    truth: Any,
    chosen: npt.NDArray[np.bool_],
    worst: list[int],
    smallest: float,
    target: str,
) -> Permitted | None:
    """What the target's specification permits; None for a target without one."""
    table = DEFAULT_TABLES.get(target)
    if table is None:
        return None
    lanes = np.flatnonzero(chosen)
    lanes = np.union1d(lanes[:: max(len(lanes) // PERMITTED_LANES, 1)], worst)
    found = permitted(library, f.name, rows(inputs, lanes), table)
    sure, expected = found.guaranteed, rows(truth, lanes)
    share = float(np.floor(1e4 * sure.mean()) / 1e4)
    if not sure.any():
        return Permitted(table, float("inf"), float("inf"), share)
    ends = (found.low, found.high)
    ulp = max(float(ulps(end, expected, smallest)[sure].max()) for end in ends)
    steps = STEPS * max(float(distances(end, expected)[sure].max()) for end in ends)
    return Permitted(table, ulp, steps, share)


def smallest_value(bound: Bound) -> float:
    """The magnitude below which ULP are those of this magnitude, since no error is promised below it."""
    if bound.measure == "absolute":
        return SMALLEST_ABSOLUTE
    return max(bound.floor, SMALLEST_NORMAL)


def distances(got: Any, expected: Any) -> Errors:
    """Largest absolute error of a lane; integers and truth values err by 0 or infinitely."""
    return _worst_field(got, expected, lambda error, size: error)


def ulps(got: Any, expected: Any, smallest: float) -> Errors:
    """The same over float32's spacing at the value; for vectors at their largest component."""

    def in_ulps(error: Errors, size: Errors) -> Errors:
        value = np.clip(size, smallest, LARGEST_SINGLE).astype(np.float32)
        return np.asarray(error / np.spacing(value).astype(np.float64))

    return _worst_field(got, expected, in_ulps)


def _worst_field(got: Any, expected: Any, judge: Callable[[Errors, Errors], Errors]) -> Errors:
    """The largest over the fields; `judge` gets the error and the size of every lane."""
    wanted = dict(measure.fields(expected))
    parts = []
    for name, a in measure.fields(got):
        x = np.asarray(wanted[name])
        if a.dtype.kind != "f":
            wrong = (a != x).any(axis=-1) if a.ndim == 2 else a != x
            parts.append(np.where(wrong, np.inf, 0.0))
            continue
        with np.errstate(invalid="ignore", over="ignore"):
            error = np.abs(a.astype(np.float64) - x.astype(np.float64))
        error, size = np.where(np.isfinite(a), error, np.inf), np.abs(x.astype(np.float64))
        if error.ndim == 2:
            error, size = error.max(axis=-1), size.max(axis=-1)
        parts.append(judge(error, size))
    return np.asarray(np.maximum.reduce(parts), np.float64)


def _in_words(bound: Bound, base: Function, cut: Function) -> str:
    """The bound's domain, and where the members together allow less than the base's signature."""
    whole = domains(base)
    less = [
        f"{path} {d.describe()}" for path, d in domains(cut).items() if d is not None and d != whole[path]
    ]
    return "; ".join([bound.domain, *less])


def reference_of(f: Function, base: Function) -> Callable[..., Any] | None:
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
