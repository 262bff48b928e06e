"""Many functions in one program, each with its own inputs: one compilation instead of one per function."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.backends import complete_program, dialect
from codegen.emit.dialect import Dialect
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.emit.stmt import StmtPrinter
from codegen.evaluate.arrays import Value, arithmetic, broadcast, convert_inputs
from codegen.execute import Runtime, Words, flatten, unflatten
from codegen.ir import nodes as ir
from codegen.ir.types import I32, Scalar, Struct, Type, Vector, leaves
from codegen.ir.unit import Unit
from codegen.library import Library
from codegen.passes.printing.rename import add_prefix


@dataclass(frozen=True)
class Job:
    """One call of a function over lanes of inputs."""

    name: str
    inputs: Mapping[str, Any]


def program(library: Library, names: Sequence[str], target: str, dialect_name: str | None = None) -> str:
    """The complete program that calls the functions one after the other; a name may stand several times."""
    chosen = dialect(target, dialect_name)
    text = emit(library, chosen, list(dict.fromkeys(names)))
    return complete_program(target, text, "\n".join(body(library, names, chosen)))


def body(library: Library, names: Sequence[str], chosen: Dialect) -> list[str]:
    """The statements of the entry point: each function's words follow those of the one before."""
    selection = library.select(names)
    renamed = add_prefix(Unit(selection.functions, selection.structs), DEFAULT_PREFIX)
    found = {f.name: f for f in renamed.functions}
    printer = StmtPrinter(chosen)
    lines: list[str] = []
    slot_in = slot_out = 0

    def load(type_: Type) -> ir.Expr:
        nonlocal slot_in
        if isinstance(type_, Scalar):
            slot_in += 1
            return ir.Call(type_, f"load_{type_.name}", (ir.Const(I32, slot_in - 1),))
        assert isinstance(type_, Struct | Vector), "random programs read no maps"
        parts = [f.type for f in type_.fields] if isinstance(type_, Struct) else [type_.element] * type_.size
        return ir.Construct(type_, tuple(load(part) for part in parts))

    for k, name in enumerate(names):
        function = found[DEFAULT_PREFIX + name]
        call = ir.Call(function.returns, function.name, tuple(load(p.type) for p in function.parameters))
        lines += printer.block((ir.Let(f"result_{k}", call),), "    ")
        for path, scalar in leaves(function.returns):
            lines.append(f"    store_{scalar.name}({slot_out}, result_{k}{path});")
            slot_out += 1
    return lines


def run(library: Library, jobs: Sequence[Job], runtime: Runtime, lanes: int) -> list[Value]:
    """The results of all jobs, in order. Each job has `lanes` inputs, or one that all lanes share.

    Raises the runtime's BuildFailed where the driver refuses the text.
    """
    text = program(library, [job.name for job in jobs], runtime.device.target)
    functions = [library.function(job.name) for job in jobs]
    words = np.concatenate(
        [input_words(f, job.inputs, lanes) for f, job in zip(functions, jobs, strict=True)]
    )
    counts = [len(leaves(f.returns)) for f in functions]
    out = runtime.run(text, words, sum(counts))
    ends = np.cumsum(counts)
    return [
        unflatten(f.returns, out[end - count : end])
        for f, count, end in zip(functions, counts, ends, strict=True)
    ]


def input_words(function: ir.Function, inputs: Mapping[str, Any], lanes: int) -> Words:
    """A function's inputs as words, (slots, lanes)."""
    types = {p.name: p.type for p in function.parameters}
    arrays, count = convert_inputs(types, inputs, arithmetic("float32"), function.name)
    if count not in (1, lanes):
        raise ValueError(f"{function.name}: {count} inputs for {lanes} lanes")
    return flatten([broadcast(arrays[p.name], lanes) for p in function.parameters], lanes)
