"""Running a library function on a device: inputs to words, a program to a runtime, words to values."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from codegen.backends import complete_program, dialect
from codegen.emit.dialect import Dialect
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.emit.stmt import StmtPrinter
from codegen.evaluate.arrays import Array, Value, arithmetic, convert_inputs
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, Scalar, Struct, Type, Vector, leaves
from codegen.ir.unit import Unit
from codegen.library import Library
from codegen.passes.rename import add_prefix

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
    dialect_name: str | None = None,
) -> Value:
    """The function's values over arrays of inputs, computed in float32 by a device.

    Inputs and result have the shapes of codegen.evaluate.evaluate. Raises UserError for bad inputs and the
    runtime's BuildFailed where the driver refuses the text.
    """
    function = library.function(name)
    arrays, count = convert_inputs(
        {p.name: p.type for p in function.parameters}, inputs, arithmetic("float32"), name
    )
    program = kernel(library, name, runtime.device.target, dialect_name)
    words = flatten([arrays[p.name] for p in function.parameters], count)
    out = runtime.run(program, words, len(leaves(function.returns)))
    return unflatten(function.returns, out)


@functools.lru_cache(maxsize=512)
def kernel(library: Library, name: str, target: str, dialect_name: str | None = None) -> str:
    """The complete program that maps a function over lanes of words."""
    chosen = dialect(target, dialect_name)
    return complete_program(target, emit(library, chosen, [name]), "\n".join(body(library, name, chosen)))


def body(library: Library, name: str, chosen: Dialect) -> list[str]:
    """The statements of the entry point: load the words, call, store the words."""
    selection = library.select([name])
    renamed = add_prefix(Unit(selection.functions, selection.structs), DEFAULT_PREFIX)
    function = renamed.functions[-1]
    slot = 0

    def load(type_: Type) -> ir.Expr:
        nonlocal slot
        if isinstance(type_, Scalar):
            slot += 1
            return ir.Call(type_, f"load_{type_.name}", (ir.Const(I32, slot - 1),))
        parts = [f.type for f in type_.fields] if isinstance(type_, Struct) else [type_.element] * type_.size
        return ir.Construct(type_, tuple(load(part) for part in parts))

    arguments = [load(p.type) for p in function.parameters]
    printer = StmtPrinter(chosen)
    call = ir.Call(function.returns, function.name, tuple(arguments))
    lines = printer.block((ir.Let("result", call),), "    ")
    for k, (path, scalar) in enumerate(leaves(function.returns)):
        lines.append(f"    store_{scalar.name}({k}, result{path});")
    return lines


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
