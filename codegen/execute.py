"""Running a library function on a device: inputs to words, a program to a runtime, words to values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from codegen.backends import dialect, texture_data
from codegen.errors import UserError
from codegen.evaluate.arrays import Array, Value, arithmetic, convert_inputs
from codegen.evaluate.interpreter import with_edges
from codegen.evaluate.textures import as_map
from codegen.ir.nodes import Function
from codegen.ir.types import BOOL, F16, F32, Scalar, Struct, Type, Vector, element_of, leaves
from codegen.kernels import PLAIN, KernelOptions, called_type, kernel, literal_cases, literal_kernel
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

    def run(self, program: str, words: Words, slots_out: int, textures: Sequence[Any] = ()) -> Words: ...


def execute(
    library: Library,
    name: str,
    inputs: Mapping[str, Any],
    runtime: Runtime,
    *,
    options: KernelOptions = PLAIN,
) -> Value:
    """The function's values over arrays of inputs, computed in float32 by a device.

    Inputs and result have the shapes of codegen.evaluate.evaluate. In half precision inputs are rounded to
    half here, so that no driver's rounding is in the result, and the result is float32. Raises UserError for
    bad inputs and the runtime's BuildFailed where the driver refuses the text.
    """
    library.function(name)
    check_precision(runtime, options)
    function = called_type(library, name, options)
    arrays, count = convert_inputs(
        {p.name: p.type for p in function.parameters}, inputs, arithmetic("float32"), name
    )
    arrays = {p.name: rounded_halves(p.type, arrays[p.name]) for p in function.parameters}
    if options.source == "literal":
        out = _execute_literals(library, name, function.returns, arrays, count, runtime, options)
        return unflatten(function.returns, out)
    program = kernel(library, name, runtime.device.target, options)
    words, maps = on_device(function, arrays, count)
    # Runtimes that know no maps are asked as they always were.
    further = {"textures": maps} if maps else {}
    out = runtime.run(program, words, len(leaves(function.returns)), **further)
    return unflatten(function.returns, out)


def on_device(function: Function, arrays: Mapping[str, Value], count: int) -> tuple[Words, list[Any]]:
    """The words and the maps that a kernel of a function takes, of arguments as convert_inputs gives them."""
    held = with_edges(function, dict(arrays))
    words = flatten([held[p.name] for p in function.parameters], count)
    maps = [t for p in function.parameters if (t := as_map(held[p.name])) is not None]
    return words, [texture_data(t.levels, t.repeat_u, t.repeat_v) for t in maps]


def check_precision(runtime: Runtime, options: KernelOptions) -> None:
    """Raise UserError where a device has no half arithmetic and the target cannot do without."""
    target = runtime.device.target
    needed = options.precision == "half" and dialect(target, options.dialect).half_enable
    if needed and not getattr(runtime, "half_arithmetic", False):
        raise UserError(f"this device of {target} has no half arithmetic; it refuses {needed}")


def _execute_literals(
    library: Library,
    name: str,
    returns: Type,
    arrays: Mapping[str, Value],
    count: int,
    runtime: Runtime,
    options: KernelOptions,
) -> Words:
    """The words of every lane, with its arguments written into the text of a program."""
    slots, most = len(leaves(returns)), literal_cases(returns)
    parts = []
    for start in range(0, count, most):
        taken = min(most, count - start)
        part = {key: _lanes(value, start, start + taken) for key, value in arrays.items()}
        program = literal_kernel(library, name, runtime.device.target, part, taken, options)
        out = runtime.run(program, np.empty((0, 1), np.uint32), taken * slots)
        parts.append(out.reshape(taken, slots).T)
    return np.concatenate(parts, axis=1)


def rounded_halves(type_: Type, value: Value) -> Value:
    """The value with every f16 in it rounded to half, still as float32."""
    if isinstance(type_, Struct):
        assert isinstance(value, dict)
        return {f.name: rounded_halves(f.type, value[f.name]) for f in type_.fields}
    if element_of(type_) != F16:
        return value
    assert isinstance(value, np.ndarray)
    with np.errstate(over="ignore"):  # beyond the largest half: infinite
        return value.astype(np.float16).astype(np.float32)


def _lanes(value: Value, start: int, stop: int) -> Value:
    if as_map(value) is not None:
        return value
    if isinstance(value, dict):
        return {name: _lanes(part, start, stop) for name, part in value.items()}
    return value[start:stop]


def flatten(values: list[Value], count: int) -> Words:
    """All scalars of the values as 32-bit words, one row per scalar."""
    rows: list[Array] = []

    def visit(value: Value) -> None:
        if as_map(value) is not None:
            return
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
            if element in (F16, F32)
            else row.view(np.int32 if element.name == "i32" else np.uint32)
        )

    def build(t: Type) -> Value:
        if isinstance(t, Struct):
            return {f.name: build(f.type) for f in t.fields}
        if isinstance(t, Vector):
            return np.stack([scalar(t.element) for _ in range(t.size)], axis=-1)
        assert isinstance(t, Scalar)
        return scalar(t)

    return build(type_)
