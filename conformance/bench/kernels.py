"""Programs that do nothing but evaluate one function many times over.

Every lane loads its inputs once. A chain keeps the sum of its last result; before each evaluation eps times
that sum is added to every float input (for integers: the bits of the sum, masked). eps and the mask are read
at run time and are 0, so that the inputs stay inside their domain while no compiler can know it: nothing can
be hoisted out of the loop, shared between chains or dropped.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from codegen.backends import complete_program, dialect
from codegen.emit.dialect import Dialect
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.emit.stmt import StmtPrinter
from codegen.execute import Words
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, TEXTURE, U32, Scalar, Struct, Type, Vector, leaves
from codegen.ir.unit import Unit
from codegen.kernels import TEXTURE_STEM
from codegen.library import Library
from codegen.passes.printing.rename import add_prefix

INDENT = "    "


@dataclass(frozen=True)
class Mode:
    """How the evaluations of a kernel depend on each other.

    name    latency: each waits for the last one; throughput: several chains side by side; flat: one chain
            without a loop, for compilers that only then work on several lanes at once
    chains  independent chains in one lane
    length  evaluations that a chain makes in one step
    looped  whether the steps are a loop; a kernel without one takes a single step
    """

    name: str
    chains: int
    length: int = 1
    looped: bool = True

    @property
    def evaluations(self) -> int:
        """How many a lane makes in one step."""
        return self.chains * self.length


LATENCY = Mode("latency", 1)
THROUGHPUT = Mode("throughput", 8)
FLAT = Mode("flat", 1, length=8, looped=False)


def modes(target: str) -> tuple[Mode, ...]:
    """The modes that are measured on a target."""
    return (THROUGHPUT, LATENCY, FLAT) if target == "opencl" else (THROUGHPUT, LATENCY)


def kernel(library: Library, name: str, target: str, mode: Mode, repeats: int = 1) -> str:
    """The program that evaluates a function `repeats` times per step and chain."""
    chosen = dialect(target)
    selection = library.select([name])
    function = add_prefix(Unit(selection.functions, selection.structs), DEFAULT_PREFIX).functions[-1]
    lines = _Body(function, chosen, mode).lines(call=True, repeats=repeats)
    maps = [TEXTURE_STEM + p.name for p in library.function(name).parameters if p.type == TEXTURE]
    return complete_program(target, emit(library, chosen, [name]), "\n".join(lines), textures=maps)


def baseline(library: Library, name: str, target: str, mode: Mode, repeats: int = 1) -> str:
    """The same program with the sum of the inputs in the function's place."""
    lines = _Body(library.function(name), dialect(target), mode).lines(call=False, repeats=repeats)
    return complete_program(target, "", "\n".join(lines))


def words(inputs: Words, steps: int) -> Words:
    """The input of a kernel: the function's own words, then eps, the mask and the number of steps."""
    controls = np.zeros((3, inputs.shape[1]), np.uint32)
    controls[2] = steps
    return np.concatenate([inputs, controls])


class _Body:
    """The statements of one kernel's entry point."""

    def __init__(self, function: ir.Function, chosen: Dialect, mode: Mode) -> None:
        self.function = function
        self.dialect = chosen
        self.mode = mode
        numbers = [p for p in function.parameters if p.type != TEXTURE]
        self.inputs = [scalar for p in numbers for _, scalar in leaves(p.type)]
        results = [scalar for _, scalar in leaves(function.returns)]
        self.state = F32 if F32 in results else U32

    def lines(self, *, call: bool, repeats: int) -> list[str]:
        printer = StmtPrinter(self.dialect)
        lines = printer.block(tuple(self._prologue()), INDENT)
        step: list[ir.Stmt] = []
        for repeat in range(repeats * self.mode.length):
            for chain in range(self.mode.chains):
                step += self._evaluation(chain, f"{chain}_{repeat}", call=call)
        if self.mode.looped:
            lines += [self._loop_head(), *printer.block(tuple(step), 2 * INDENT), INDENT + "}"]
        else:
            lines += printer.block(tuple(step), INDENT)
        total = self._total([self._sum(chain) for chain in range(self.mode.chains)])
        return [*lines, f"{INDENT}store_{self.state.name}(0, {printer.expr.show(total)});"]

    def _prologue(self) -> Iterator[ir.Stmt]:
        for k, scalar in enumerate(self.inputs):
            yield ir.Let(f"word_{k}", _load(scalar, k))
        count = len(self.inputs)
        yield ir.Let("epsilon", _load(F32, count))
        yield ir.Let("bit_mask", _load(U32, count + 1))
        yield ir.Let("step_count", _load(I32, count + 2))
        for chain in range(self.mode.chains):
            first = ir.Const(F32, 0.125 * chain) if self.state == F32 else ir.Const(U32, chain)
            yield ir.Let(f"sum_{chain}", first, mutable=True)

    def _loop_head(self) -> str:
        """A loop whose length is known at run time only: no compiler unrolls it, and no text fixes it."""
        if self.dialect.declaration == "name: type":
            return INDENT + "for (var step_index = 0; step_index < step_count; step_index++) {"
        return INDENT + "for (int step_index = 0; step_index < step_count; step_index++) {"

    def _evaluation(self, chain: int, suffix: str, *, call: bool) -> Iterator[ir.Stmt]:
        state = self._sum(chain)
        if F32 in self.inputs:
            as_float = state if self.state == F32 else ir.Convert(F32, state)
            product = ir.Binary(F32, "*", ir.Var(F32, "epsilon"), as_float)
            yield ir.Let(f"delta_{suffix}", product)
        if any(scalar != F32 for scalar in self.inputs):
            as_bits = state if self.state == U32 else ir.Builtin(U32, "float_to_bits", (state,))
            yield ir.Let(f"bits_{suffix}", ir.Binary(U32, "&", as_bits, ir.Var(U32, "bit_mask")))
        moved = [self._moved(k, scalar, suffix) for k, scalar in enumerate(self.inputs)]
        if call:
            supply = iter(moved)
            arguments = tuple(
                ir.Var(TEXTURE, TEXTURE_STEM + p.name) if p.type == TEXTURE else _assemble(p.type, supply)
                for p in self.function.parameters
            )
            result = f"value_{suffix}"
            yield ir.Let(result, ir.Call(self.function.returns, self.function.name, arguments))
            moved = _parts(ir.Var(self.function.returns, result))
        yield ir.Assign(state.name, self._total(moved))

    def _moved(self, k: int, scalar: Scalar, suffix: str) -> ir.Expr:
        """An input with eps times the last sum added, or an integer with the masked bits of it."""
        value = ir.Var(scalar, f"word_{k}")
        bits = ir.Var(U32, f"bits_{suffix}")
        if scalar == F32:
            return ir.Binary(F32, "+", value, ir.Var(F32, f"delta_{suffix}"))
        if scalar == BOOL:
            return ir.Binary(BOOL, "or", value, ir.Binary(BOOL, "!=", bits, ir.Const(U32, 0)))
        return ir.Binary(scalar, "+", value, bits if scalar == U32 else ir.Convert(I32, bits))

    def _sum(self, chain: int) -> ir.Var:
        return ir.Var(self.state, f"sum_{chain}")

    def _total(self, parts: Sequence[ir.Expr]) -> ir.Expr:
        """The sum of scalars of any type in the type of the chains."""
        total: ir.Expr | None = None
        for part in parts:
            term = self._as_state(part)
            total = term if total is None else ir.Binary(self.state, "+", total, term)
        assert total is not None
        return total

    def _as_state(self, part: ir.Expr) -> ir.Expr:
        if part.type == self.state:
            return part
        if part.type == BOOL:
            one, none = (1.0, 0.0) if self.state == F32 else (1, 0)
            return ir.Select(self.state, part, ir.Const(self.state, one), ir.Const(self.state, none))
        if self.state == U32 and part.type == F32:
            return ir.Builtin(U32, "float_to_bits", (part,))
        return ir.Convert(self.state, part)


def _load(scalar: Scalar, slot: int) -> ir.Expr:
    return ir.Call(scalar, f"load_{scalar.name}", (ir.Const(I32, slot),))


def _assemble(type_: Type, supply: Iterator[ir.Expr]) -> ir.Expr:
    """A value of the type from scalars in order."""
    if isinstance(type_, Scalar):
        return next(supply)
    assert isinstance(type_, Struct | Vector), f"a {type_.name} is not made of scalars"
    parts = [f.type for f in type_.fields] if isinstance(type_, Struct) else [type_.element] * type_.size
    return ir.Construct(type_, tuple(_assemble(part, supply) for part in parts))


def _parts(value: ir.Expr) -> list[ir.Expr]:
    """The scalars of a value, in order."""
    if isinstance(value.type, Struct):
        return [part for f in value.type.fields for part in _parts(ir.Member(f.type, value, f.name))]
    if isinstance(value.type, Vector):
        components = "xyzw"[: value.type.size]
        return [ir.Swizzle(value.type.element, value, c) for c in components]
    return [value]
