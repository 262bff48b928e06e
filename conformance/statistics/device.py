"""Evaluates library functions on a device in the shape that the statistical checks take."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.execute import execute
from codegen.library import Library
from conformance.statistics.evaluator import Array, Call
from targets import TimedRuntime


def device_call(library: Library, runtime: TimedRuntime) -> Call:
    """Calls by keyword: real inputs are rounded to float32, results come back as float64 or words."""

    def call(name: str, inputs: Mapping[str, Any]) -> Any:
        ordered = {p.name: narrow(inputs[p.name]) for p in library.function(name).parameters}
        return widen(execute(library, name, ordered, runtime))

    return call


def narrow(x: Any) -> Any:
    """float64 to float32, integers as they are; structs field by field."""
    if isinstance(x, Mapping):
        return {name: narrow(value) for name, value in x.items()}
    values: npt.NDArray[Any] = np.asarray(x)
    return values.astype(np.float32) if values.dtype.kind == "f" else values


def widen(x: Any) -> Any:
    """float32 to float64, integers as they are; structs field by field."""
    if isinstance(x, Mapping):
        return {name: widen(value) for name, value in x.items()}
    values: npt.NDArray[Any] = np.asarray(x)
    return values.astype(np.float64) if values.dtype.kind == "f" else values


def rounded_unit(v: Array) -> Array:
    """A unit vector whose components are float32 numbers."""
    return np.asarray(v, dtype=np.float32).astype(np.float64)
