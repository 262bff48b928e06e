"""Backends for pictures: the three targets, and the evaluator of the library in two precisions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.backends import TARGETS, open_runtime
from codegen.errors import unknown
from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.ir.domains import Interval
from codegen.ir.nodes import Parameter
from codegen.ir.types import Field, Struct
from codegen.library import Library
from conformance.picture.shade import Backend, Models, Slot

ARITHMETICS = {"numpy": "float64", "numpy32": "float32"}
SHADES = "_shade"
NAMES = (*TARGETS, *ARITHMETICS)


def open_backend(name: str, library: Library) -> Backend:
    """The backend of that name.

    errors  UserError for an unknown name, and where a target has no driver here
    """
    if name in ARITHMETICS:
        arithmetic = ARITHMETICS[name]

        def on_host(function: str, inputs: Mapping[str, Any]) -> npt.NDArray[Any]:
            return np.asarray(evaluate(library, function, inputs, arithmetic))

        return Backend(name, f"NumPy {np.__version__}, {arithmetic}", on_host)
    if name not in TARGETS:
        raise unknown("target", name, NAMES)
    runtime = open_runtime(name)

    def on_device(function: str, inputs: Mapping[str, Any]) -> npt.NDArray[Any]:
        return np.asarray(execute(library, function, inputs, runtime))

    return Backend(name, f"{runtime.device.driver}, {runtime.device.device}", on_device)


def models(library: Library) -> Models:
    """The functions a picture can be shaded with; one is read when it is asked for."""

    def slots(name: str) -> tuple[Slot, ...]:
        parameters = library.function(name).parameters
        return tuple(slot for parameter in parameters for slot in _slots(parameter, ""))

    return Models(tuple(name for name in library.resolver.function_names() if SHADES in name), slots)


def _slots(owner: Parameter | Field, prefix: str) -> list[Slot]:
    name = f"{prefix}{owner.name}"
    if isinstance(owner.type, Struct):
        return [slot for field in owner.type.fields for slot in _slots(field, f"{name}.")]
    interval = owner.domain if isinstance(owner.domain, Interval) else None
    bounds = (interval.low, interval.high) if interval else None
    return [Slot(name, getattr(owner.type, "size", 1), bounds)]
