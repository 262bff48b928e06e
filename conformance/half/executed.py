"""Half forms on devices that compute in half precision."""

from __future__ import annotations

from typing import Any

from codegen.execute import execute
from codegen.half import HalfForm
from codegen.kernels import KernelOptions
from codegen.library import Library
from conformance.check import measure
from conformance.half.survey import half_sample
from targets import TARGETS, TargetUnavailable, TimedRuntime, open_runtime

HALF = KernelOptions(precision="half")


def devices() -> list[TimedRuntime]:
    """The devices of this machine with half arithmetic."""
    found = []
    for target in TARGETS:
        try:
            runtime = open_runtime(target)
        except TargetUnavailable:
            continue
        if runtime.half_arithmetic:
            found.append(runtime)
    return found


def executed_error(library: Library, form: HalfForm, runtime: TimedRuntime) -> float:
    """The largest error of a half form inside its range on a device, in the measure of its bound."""
    sample = half_sample(library, library.function(form.function), form.single, form.where)
    got = execute(library, form.function, sample.inputs, runtime, options=HALF)
    errors = measure.error(form.bounds[0], got, sample.truth)
    return float(errors[sample.inside(dict(form.where or {}))].max())


def record(library: Library, form: HalfForm, runtime: TimedRuntime) -> dict[str, Any]:
    """The same as data, with the driver."""
    d = runtime.device
    error = float(f"{executed_error(library, form, runtime):.2g}")
    return {"target": d.target, "driver": d.driver, "error": error}
