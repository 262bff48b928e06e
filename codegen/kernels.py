"""Complete programs that map one library function over lanes of words, in every way a driver sees it."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from codegen.backends import complete_program, dialect
from codegen.emit.dialect import Dialect, with_half, with_precise
from codegen.emit.module import DEFAULT_PREFIX, HALF_PREFIX, emit
from codegen.emit.stmt import StmtPrinter
from codegen.errors import UserError
from codegen.half import half_rules
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F16, F32, I32, TEXTURE, Array, Scalar, Struct, Type, Vector, leaves
from codegen.ir.unit import Unit
from codegen.library import Library
from codegen.passes.half import half_versions
from codegen.passes.printing.rename import add_prefix

LITERAL_CASES = 8
"""Calls with literal arguments in one program, at most."""
LITERAL_WORDS = 32
"""Words that all these calls store, at most: what a fragment can write."""


TEXTURE_STEM = "harness_"
"""Before the name of a parameter: the global that holds its map."""


@dataclass(frozen=True)
class KernelOptions:
    """How a kernel is written.

    dialect  of the target; its default if None
    version  GLSL only: what follows #version, where the dialect's default does not fit the driver
    form     of the harness: plain, pair, uniform or fragment; see targets.harness
    source   where arguments come from: loaded words, or literals in the text
    precision  "half": the function's half form; words still hold float32, converted on the device
    precise  whether every float local is qualified, see codegen.emit.dialect.with_precise
    prelude  text before the library
    """

    dialect: str | None = None
    version: str | None = None
    form: Literal["plain", "pair", "uniform", "fragment"] = "plain"
    source: Literal["words", "literal"] = "words"
    precise: bool = False
    prelude: str = ""
    precision: Literal["single", "half"] = "single"


PLAIN = KernelOptions()


def kernel(library: Library, name: str, target: str, options: KernelOptions = PLAIN) -> str:
    """The complete program that loads a function's arguments, calls it and stores its value."""
    return _kernel(library, name, target, options)


@functools.lru_cache(maxsize=512)
def _kernel(library: Library, name: str, target: str, options: KernelOptions) -> str:
    # Behind a function without defaults, since the cache takes a call with and without them for two.
    body = kernel_body(library, name, target, options)
    return _complete(library, name, target, options, body)


def kernel_body(library: Library, name: str, target: str, options: KernelOptions = PLAIN) -> str:
    """What stands for $body in the harness: the statements that load, call and store."""
    chosen = _dialect(target, options)
    call = _called(library, name, options)
    return "\n".join(_pair(call, chosen) if options.form == "pair" else _single(call, chosen))


def literal_kernel(
    library: Library,
    name: str,
    target: str,
    inputs: Mapping[str, Any],
    count: int,
    options: KernelOptions = PLAIN,
) -> str:
    """The program of one lane that calls a function with literals, once for each of `count` inputs.

    The words of call j follow those of call j - 1.
    """
    function = _called(library, name, options)
    printer = StmtPrinter(_dialect(target, options))
    slots = leaves(function.returns)
    lines = []
    for j in range(count):
        arguments = [_constant(p.type, inputs[p.name], j) for p in function.parameters]
        call = ir.Call(function.returns, function.name, tuple(arguments))
        lines += printer.block(_result(f"result_{j}", call), "    ")
        lines += _stores(function.returns, f"result_{j}", j * len(slots), printer)
    return _complete(library, name, target, options, "\n".join(lines))


def literal_cases(type_: Type) -> int:
    """How many calls that return this type one literal_kernel holds."""
    return max(min(LITERAL_CASES, LITERAL_WORDS // len(leaves(type_))), 1)


def _dialect(target: str, options: KernelOptions) -> Dialect:
    chosen = dialect(target, options.dialect)
    chosen = with_half(chosen) if options.precision == "half" else chosen
    return with_precise(chosen) if options.precise else chosen


def called_type(library: Library, name: str, options: KernelOptions = PLAIN) -> ir.Function:
    """The function that a kernel calls, without a prefix: its parameters and result have the types in use."""
    if options.precision == "half":
        return half_versions(library, [name], half_rules(library))[-1].function
    return library.function(name)


def _called(library: Library, name: str, options: KernelOptions) -> ir.Function:
    if options.precision == "half":
        return add_prefix(Unit((called_type(library, name, options),), ()), HALF_PREFIX).functions[-1]
    selection = library.select([name])
    return add_prefix(Unit(selection.functions, selection.structs), DEFAULT_PREFIX).functions[-1]


def _complete(library: Library, name: str, target: str, options: KernelOptions, body: str) -> str:
    text = options.prelude + emit(library, _dialect(target, options), [name])
    maps = [TEXTURE_STEM + p.name for p in library.function(name).parameters if p.type == TEXTURE]
    if maps and (options.form != "plain" or options.source != "words"):
        raise UserError(f"{name} reads maps: only kernels of the form plain, with loaded words, pass them")
    return complete_program(target, text, body, options.version, options.form, maps)


def _single(function: ir.Function, chosen: Dialect) -> list[str]:
    printer = StmtPrinter(chosen)
    lines = printer.block(_result("result", _loaded_call(function)), "    ")
    return [*lines, *_stores(function.returns, "result", 0, printer)]


def _pair(function: ir.Function, chosen: Dialect) -> list[str]:
    """Both calls stand before the first store, so that a compiler may interleave them."""
    printer = StmtPrinter(chosen)
    calls, stores = [], []
    for j in range(2):
        take = f"    harness_take({j}{'' if chosen.target == 'wgsl' else 'u'});"
        calls += [take, *printer.block(_result(f"result_{j}", _loaded_call(function)), "    ")]
        stores += [take, *_stores(function.returns, f"result_{j}", 0, printer)]
    return [*calls, *stores]


def _result(name: str, call: ir.Call) -> tuple[ir.Stmt, ...]:
    """The local that holds a call's value; arrays are handed over by name, as C wants it."""
    body: list[ir.Stmt] = []
    arguments: list[ir.Expr] = []
    for k, a in enumerate(call.args):
        if isinstance(a.type, Array):
            body.append(ir.Let(f"{name}_array_{k}", a))
            a = ir.Var(a.type, f"{name}_array_{k}")
        arguments.append(a)
    return (*body, ir.Let(name, replace(call, args=tuple(arguments))))


def _loaded_call(function: ir.Function) -> ir.Call:
    slot = 0

    def load(scalar: Scalar) -> ir.Expr:
        nonlocal slot
        slot += 1
        if scalar == F16:
            return ir.Convert(F16, ir.Call(F32, "load_f32", (ir.Const(I32, slot - 1),)))
        return ir.Call(scalar, f"load_{scalar.name}", (ir.Const(I32, slot - 1),))

    arguments = tuple(
        ir.Var(TEXTURE, TEXTURE_STEM + p.name) if p.type == TEXTURE else _built(p.type, load)
        for p in function.parameters
    )
    return ir.Call(function.returns, function.name, arguments)


def _built(type_: Type, load: Callable[[Scalar], ir.Expr]) -> ir.Expr:
    """A value of the type from its scalars, in order."""
    if isinstance(type_, Scalar):
        return load(type_)
    assert isinstance(type_, Struct | Vector)
    parts = [f.type for f in type_.fields] if isinstance(type_, Struct) else [type_.element] * type_.size
    return ir.Construct(type_, tuple(_built(part, load) for part in parts))


def _constant(type_: Type, values: Any, lane: int) -> ir.Expr:
    """One lane of an input as literals."""
    if isinstance(type_, Struct):
        return ir.Construct(type_, tuple(_constant(f.type, values[f.name], lane) for f in type_.fields))
    scalars = iter(np.atleast_1d(np.asarray(values[lane])).tolist())

    def literal(scalar: Scalar) -> ir.Expr:
        value = next(scalars)
        return ir.Const(
            scalar, value if scalar == BOOL else float(value) if scalar in (F16, F32) else int(value)
        )

    return _built(type_, literal)


def _stores(type_: Type, variable: str, first: int, printer: StmtPrinter) -> list[str]:
    def stored(scalar: Scalar, value: str) -> tuple[str, str]:
        if scalar == F16:
            return "f32", printer.expr.show(ir.Convert(F32, ir.Var(F16, value)))
        return scalar.name, value

    words = [stored(scalar, variable + path) for path, scalar in leaves(type_)]
    return [f"    store_{name}({first + k}, {value});" for k, (name, value) in enumerate(words)]
