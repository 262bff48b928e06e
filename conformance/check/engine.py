"""Checking one function on one target: draw inputs, run, compare with the reference under its bounds."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.ir.nodes import Function
from codegen.kernels import kernel
from codegen.library import Library
from conformance import cases
from conformance.check import measure, show
from conformance.check.features import applies
from conformance.check.identity import Identity
from conformance.check.result import BoundResult, Failure, FunctionResult
from conformance.reference import PROPERTY_ONLY, ambiguous, reference_for
from targets import TARGETS, open_runtime

UNIFORM_COUNT = 20_000
"""Random points per function where no other number is asked for."""
FAMILY_COUNT = 2_000
"""Most points taken from one family of hard cases."""
SEED = 20_260
"""Seed of the random points; stated in every replay identity."""
MAX_FAILURES = 5
"""Failures reported in full per function and target; all are counted."""

Run = Callable[[Library, str, Mapping[str, Any]], Any]


@dataclass(frozen=True)
class Backend:
    """Something that computes a function in float32: a target's device, or the evaluator.

    name  as a replay identity carries it: the target, or a driver with its mode
    """

    target: str
    driver: str
    run: Run
    name: str = ""


def backend(target: str) -> Backend:
    """A target's backend, or "numpy": the IR evaluated op by op in float32. Raises TargetUnavailable."""
    if target == "numpy":
        return Backend("numpy", f"numpy {np.__version__}, float32 op by op", evaluate)
    runtime = open_runtime(target)
    d = runtime.device

    def run(library: Library, name: str, inputs: Mapping[str, Any]) -> Any:
        return execute(library, name, inputs, runtime)

    return Backend(target, f"{d.api}; {d.driver}; {d.device}", run)


@dataclass(frozen=True)
class Draw:
    """One named set of inputs."""

    family: str
    count: int
    seed: int
    inputs: dict[str, Any]


def draws(function: Function, uniform: int = UNIFORM_COUNT, family: int = FAMILY_COUNT) -> Iterable[Draw]:
    """Random points, the worst inputs that searches found, every family that fits the parameters."""
    for name, count in [
        ("uniform", uniform),
        *([(cases.WORST, 0)] if cases.has_worst(function) else []),
        *((f, family) for f in cases.families_for(function.parameters)),
    ]:
        yield draw(function, name, count, SEED)


def draw(function: Function, family: str, count: int, seed: int) -> Draw:
    """One set of inputs, the same for the same arguments."""
    inputs = cases.worst(function) if family == cases.WORST else cases.draw(function, family, count, seed)
    return (
        Draw(family, _length(inputs), seed, inputs)
        if family != "uniform"
        else Draw(family, count, seed, inputs)
    )


def only_lane(whole: Draw, lane: int) -> Draw:
    """The draw cut down to one lane."""

    def cut(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: cut(v) for name, v in value.items()}
        return value[lane : lane + 1]

    return replace(whole, inputs=cut(whole.inputs))


def _length(inputs: Mapping[str, Any]) -> int:
    first = next(iter(inputs.values()))
    return _length(first) if isinstance(first, Mapping) else len(first)


def check_function(
    library: Library, name: str, on: Backend, draws_of: Iterable[Draw] | None = None
) -> FunctionResult:
    """Check one function: every finite input inside its domain gives a finite result within its bounds."""
    function = library.function(name)
    result = FunctionResult(name, on.target, on.driver, backend=on.name or on.target)
    result.source = library.select([name]).source_hash
    result.emitted = emitted_hash(library, name, result.backend)
    bounds = [b for b in library.bounds.get(name, ()) if not b.targets or on.target in b.targets]
    started = time.perf_counter()
    if not bounds:
        result.broken = f"{name} declares no error bound for {on.target}"
        return result
    reference = find_reference(library, function)
    if reference is None:
        result.broken = f"{name} has no reference"
        return result
    errors: list[list[npt.NDArray[np.float64]]] = [[] for _ in bounds]
    result.bounds = [BoundResult(b.describe(), b.bound) for b in bounds]
    for d in draws_of or draws(function):
        _check_draw(
            result,
            bounds,
            errors,
            d,
            on.run(library, name, d.inputs),
            expected_of(reference, d.inputs),
            function,
        )
    for found, parts in zip(result.bounds, errors, strict=True):
        _summarise(found, parts)
    result.seconds = time.perf_counter() - started
    return result


def emitted_hash(library: Library, name: str, target: str) -> str:
    """Hash of the program that a target is given for a function; empty for any other backend."""
    if target not in TARGETS:
        return ""
    return hashlib.sha256(kernel(library, name, target).encode()).hexdigest()[:16]


def find_reference(library: Library, function: Function) -> Callable[..., Any] | None:
    """The independent reference; where no formula fixes a function, the evaluator: all targets agree.

    What such a function must do is tested by its properties.
    """
    if function.name in PROPERTY_ONLY:
        names = [p.name for p in function.parameters]
        return lambda *values: evaluate(library, function.name, dict(zip(names, values, strict=True)))
    try:
        return reference_for(function.name, function.base if function.kind == "variant" else None)
    except KeyError:
        return None


def expected_of(reference: Callable[..., Any], inputs: Mapping[str, Any]) -> Any:
    """The reference's values: it gets the exact float32 inputs, widened."""
    return reference(*(_widen(value) for value in inputs.values()))


def _widen(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _widen(v) for name, v in value.items()}
    a = np.asarray(value)
    return a.astype(np.float64) if a.dtype == np.float32 else a


def _check_draw(
    result: FunctionResult,
    bounds: list[Bound],
    errors: list[list[npt.NDArray[np.float64]]],
    d: Draw,
    got: Any,
    expected: Any,
    function: Function,
) -> None:
    count = _length(d.inputs)
    result.lanes += count
    finite = measure.finite(got)
    result.non_finite += int((~finite).sum())
    for lane in np.flatnonzero(~finite)[: MAX_FAILURES - len(result.failures)]:
        result.failures.append(
            _failure(result, d, int(lane), "the result is not finite", got, expected, None, "", function)
        )
    doubtful = ambiguous(function.name, d.inputs, function.base if function.kind == "variant" else None)
    result.ambiguous += int(doubtful.sum())
    covered = doubtful.copy()
    for bound, found, parts in zip(bounds, result.bounds, errors, strict=True):
        inside = applies(bound, d.inputs, count)
        covered |= inside
        inside &= finite & ~doubtful
        if not inside.any():
            continue
        error = measure.error(bound, got, expected)
        parts.append(error[inside])
        found.lanes += int(inside.sum())
        lane = int(np.argmax(np.where(inside, error, -1.0)))
        if not found.worst or error[lane] > found.measured:
            found.measured = float(error[lane])
            found.worst = show.lane_inputs(d.inputs, lane)
        failed = np.flatnonzero(inside & ~(error <= bound.bound))
        found.failures += len(failed)
        order = failed[np.argsort(-error[failed])]
        for bad in order[: max(MAX_FAILURES - len(result.failures), 0)]:
            text = f"{bound.measure} {error[bad]:.4g} exceeds {bound.bound:.4g}"
            result.failures.append(
                _failure(result, d, int(bad), "outside its bound", got, expected, bound, text, function)
            )
    result.uncovered += int((~covered).sum())


def _summarise(found: BoundResult, parts: list[npt.NDArray[np.float64]]) -> None:
    if parts:
        joined = np.concatenate(parts)
        # One of the errors, not a value between two of them: infinite ones have no difference.
        found.p999 = float(np.quantile(joined, 0.999, method="higher"))
        found.median = float(np.median(joined))


def _failure(
    result: FunctionResult,
    d: Draw,
    lane: int,
    reason: str,
    got: Any,
    expected: Any,
    bound: Bound | None,
    text: str,
    function: Function,
) -> Failure:
    field = bound.field if bound is not None else ""
    distances = []
    wanted = dict(measure.fields(expected, field))
    for name, a in measure.fields(got, field):
        if a.dtype.kind == "f":
            distance = np.max(measure.ulps(a[lane : lane + 1], wanted[name][lane : lane + 1]))
            distances.append(f"{name + ' ' if name else ''}{distance:.4g} ULP")
    return Failure(
        identity=Identity(result.function, result.backend, d.family, d.count, d.seed, lane),
        driver=result.driver,
        reason=reason,
        inputs=show.lane_inputs(d.inputs, lane),
        got=show.one(got, lane),
        expected=show.one(expected, lane),
        error=", ".join(filter(None, (text, *distances))),
        bound=bound.describe() if bound is not None else "finite input gives a finite result",
        origin=bound.origin if bound is not None else "the contract of every function",
        words=cases.words(function, d.inputs, lane),
    )
