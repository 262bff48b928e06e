"""Running a library function on a device: inputs to words, a program to a runtime, words to values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from codegen.evaluate.arrays import Array, Value, arithmetic, convert_inputs
from codegen.ir.types import BOOL, F32, Scalar, Struct, Type, Vector, leaves
from codegen.kernels import PLAIN, KernelOptions, kernel, literal_cases, literal_kernel
from codegen.library import Library

Words = npt.NDArray[np.uint32]


class Device(Protocol):
    """What a runtime says of its device."""

    @property
    def target(self) -> str: ...


class Runtime(Protocol):
    """The part of targets.protocol.Runtime that execution needs."""

    @property
    def device(self) -> Device: ...

    def run(self, program: str, words: Words, slots_out: int) -> Words: ...


def execute(
    library: Library,
    name: str,
    inputs: Mapping[str, Any],
    runtime: Runtime,
    *,
    options: KernelOptions = PLAIN,
) -> Value:
    """The function's values over arrays of inputs, computed in float32 by a device.

    Inputs and result have the shapes of codegen.evaluate.evaluate. Raises UserError for bad inputs and the
    runtime's BuildFailed where the driver refuses the text.
    """
    function = library.function(name)
    arrays, count = convert_inputs(
        {p.name: p.type for p in function.parameters}, inputs, arithmetic("float32"), name
    )
    if options.source == "literal":
        out = _execute_literals(library, name, arrays, count, runtime, options)
        return unflatten(function.returns, out)
    program = kernel(library, name, runtime.device.target, options)
    words = flatten([arrays[p.name] for p in function.parameters], count)
    out = runtime.run(program, words, len(leaves(function.returns)))
    return unflatten(function.returns, out)


def _execute_literals(
    library: Library,
    name: str,
    arrays: Mapping[str, Value],
    count: int,
    runtime: Runtime,
    options: KernelOptions,
) -> Words:
    """The words of every lane, with its arguments written into the text of a program."""
    returns = library.function(name).returns
    slots, most = len(leaves(returns)), literal_cases(returns)
    parts = []
    for start in range(0, count, most):
        taken = min(most, count - start)
        part = {key: _lanes(value, start, start + taken) for key, value in arrays.items()}
        program = literal_kernel(library, name, runtime.device.target, part, taken, options)
        out = runtime.run(program, np.empty((0, 1), np.uint32), taken * slots)
        parts.append(out.reshape(taken, slots).T)
    return np.concatenate(parts, axis=1)


def _lanes(value: Value, start: int, stop: int) -> Value:
    if isinstance(value, dict):
        return {name: _lanes(part, start, stop) for name, part in value.items()}
    return value[start:stop]


def flatten(values: list[Value], count: int) -> Words:
    """All scalars of the values as 32-bit words, one row per scalar."""
    rows: list[Array] = []

    def visit(value: Value) -> None:
        if isinstance(value, dict):
            for part in value.values():
                visit(part)
        elif value.ndim == 2:
            rows.extend(value[:, k] for k in range(value.shape[1]))
        else:
            rows.append(value)

    for value in values:
        visit(value)
    words = np.empty((len(rows), count), np.uint32)
    for k, row in enumerate(rows):
        words[k] = (
            row.astype(np.uint32) if row.dtype == np.bool_ else np.ascontiguousarray(row).view(np.uint32)
        )
    return words


def unflatten(type_: Type, words: Words) -> Value:
    """The value that rows of words hold."""
    rows = iter(words)

    def scalar(element: Scalar) -> Array:
        row = np.ascontiguousarray(next(rows))
        if element == BOOL:
            return np.asarray(row != 0)
        return (
            row.view(np.float32)
            if element == F32
            else row.view(np.int32 if element.name == "i32" else np.uint32)
        )

    def build(t: Type) -> Value:
        if isinstance(t, Struct):
            return {f.name: build(f.type) for f in t.fields}
        if isinstance(t, Vector):
            return np.stack([scalar(t.element) for _ in range(t.size)], axis=-1)
        return scalar(t)

    return build(type_)
