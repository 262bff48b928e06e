"""Walks a function's IR over interval values: calls are inlined by evaluation, loops are unrolled.

An operation on the same values is evaluated once, within a function and across calls: a value is one number,
however often it is written. (A compiler that computes one value twice in two ways is not modelled.)
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable
from typing import Any, TypeVar, cast

import numpy as np

from codegen.evaluate.textures import as_map
from codegen.intervals import logic, whole
from codegen.intervals.context import Context
from codegen.intervals.lookups import lookup
from codegen.intervals.memory import FORKS
from codegen.intervals.operations import COMPARISONS, VECTOR_BUILTINS, binary, scalar_builtin, unary
from codegen.intervals.values import (
    Range,
    Single,
    Truth,
    Value,
    Whole,
    all_of,
    always,
    any_of,
    choose,
    constant,
    opposite,
)
from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32, Scalar, Struct, Type, Vector
from codegen.library import Library

Singles = tuple[Single, ...]
V = TypeVar("V")
ALWAYS, NEVER = always(True), always(False)
FORKING = frozenset((*FORKS, *COMPARISONS))
"""Operations that count as a fork whenever they are asked for: a fork has one number for all lanes."""


class Frame:
    """One call: its locals, which lanes may still run, and what may have been returned."""

    def __init__(
        self, library: Library, context: Context, function: ir.Function, arguments: dict[str, Value]
    ):
        self.library = library
        self.context = context
        self.function = function
        self.scope = dict(arguments)
        self.result: Value | None = None
        self.returned = NEVER

    def run(self) -> Value:
        """The function's value."""
        caller = self.context.function, self.context.line
        self.block(self.function.body, ALWAYS)
        self.context.function, self.context.line = caller
        assert self.result is not None
        return self.result

    def block(self, body: tuple[ir.Stmt, ...], active: Truth) -> None:
        for s in body:
            self.context.function, self.context.line = self.function.name, s.line
            match s:
                case ir.Let():
                    self.scope[s.name] = self.expr(s.value)
                case ir.Assign():
                    self.scope[s.name] = choose(self.live(active), self.expr(s.value), self.scope[s.name])
                case ir.If():
                    condition = self.truth(s.condition)
                    self.block(s.then, all_of(active, condition))
                    self.block(s.orelse, all_of(active, opposite(condition)))
                case ir.For():
                    self.loop(s, active)
                case ir.Return():
                    value = self.expr(s.value)
                    live = self.live(active)
                    self.result = value if self.result is None else choose(live, value, self.result)
                    self.returned = any_of(self.returned, live)

    def live(self, active: Truth) -> Truth:
        """Which lanes of a block have not returned."""
        return active if self.returned is NEVER else all_of(active, opposite(self.returned))

    def loop(self, s: ir.For, active: Truth) -> None:
        """All iterations that any lane may run, and one at least; forks count as if all had run."""
        limit = None if s.limit is None else self.expr(s.limit)
        assert limit is None or isinstance(limit, Whole)
        stop = s.stop if limit is None else min(s.stop, max(s.start + 1, int(limit.high.max())))
        signed = s.index_type == I32
        first = self.context.forks
        for i in range(s.start, stop):
            key = ("i32", i) if signed else ("u32", "int", i, str(i))
            self.scope[s.name] = self.shared(key, functools.partial(constant, i, signed))
            running = ALWAYS if limit is None else Truth(limit.high > i, limit.low <= i)
            self.block(s.body, all_of(active, running))
        run = max(stop - s.start, 1)
        self.context.forks += (self.context.forks - first) // run * (s.stop - s.start - run)

    def truth(self, e: ir.Expr) -> Truth:
        value = self.expr(e)
        assert isinstance(value, Truth)
        return value

    def expr(self, e: ir.Expr) -> Value:
        """The value of an expression."""
        return _EVALUATE[type(e)](self, e)

    def const(self, e: ir.Const) -> Value:
        literals = self.context.literals
        found = literals.get(id(e))
        if found is None:
            key = (e.type.name, type(e.value).__name__, e.value, str(e.value))
            found = literals[id(e)] = (e, self.shared(key, lambda: constant(e.value, e.type == I32)))
        return found[1]

    def var(self, e: ir.Var) -> Value:
        return self.scope[e.name]

    def unary(self, e: ir.Unary) -> Value:
        return self.each(e.op, unary, (self.expr(e.operand),))

    def binary(self, e: ir.Binary) -> Value:
        return self.each(e.op, binary, (self.expr(e.left), self.expr(e.right)))

    def convert(self, e: ir.Convert) -> Value:
        return self.converted(e.type, self.expr(e.operand))

    def member(self, e: ir.Member) -> Value:
        value = self.expr(e.value)
        assert isinstance(value, dict)
        return value[e.name]

    def index(self, e: ir.Index) -> Value:
        return self.element(self.expr(e.value), self.expr(e.index))

    def swizzle(self, e: ir.Swizzle) -> Value:
        vector = self.expr(e.value)
        assert isinstance(vector, tuple)
        chosen = [vector["xyzw".index(c)] for c in e.components]
        return chosen[0] if len(chosen) == 1 else tuple(chosen)

    def select(self, e: ir.Select) -> Value:
        condition, if_true, if_false = (self.expr(c) for c in ir.children(e))
        assert isinstance(condition, Truth)
        return choose(condition, if_true, if_false)

    def element(self, value: Value, index: Value) -> Value:
        """The element of an array, or the hull of those that the number may name."""
        assert isinstance(value, dict)
        assert isinstance(index, Whole)
        found = value["0"]
        for k in range(1, len(value)):
            may, must = (index.low <= k) & (k <= index.high), (index.low == k) & (index.high == k)
            found = choose(Truth(may, ~must), value[str(k)], found)
        return found

    def shared(self, key: Hashable, make: Callable[[], Single]) -> Single:
        """The value under a key, made at its first use."""
        constants = self.context.constants
        if key not in constants:
            constants[key] = make()
        return constants[key]

    def each(self, op: str, apply: Callable[..., Single], parts: tuple[Value, ...]) -> Value:
        """An operation component by component; a scalar operand goes with every component of a vector."""
        size = 0
        for p in parts:
            if isinstance(p, tuple):
                size = len(p)
        if size == 0:
            return self.once(op, apply, parts)  # type: ignore[arg-type]
        columns = [p if isinstance(p, tuple) else (p,) * size for p in parts]
        return tuple(self.once(op, apply, components) for components in zip(*columns, strict=True))

    def once(self, op: str, apply: Callable[..., V], parts: Singles) -> V:
        """apply(context, op, *parts) of these very values; the result of the first time counts."""
        names = [p.number for p in parts]
        if op in ("+", "*"):
            names.sort()
        key = (op, *names)
        context = self.context
        found: V | None = context.memory.recall(key)
        if found is None:
            context.operation = op
            return cast(V, context.memory.keep(key, apply(context, op, *parts)))
        if op in FORKING:
            context.decided()
        return found

    def builtin(self, e: ir.Builtin) -> Value:
        op, args = e.op, tuple(self.expr(a) for a in e.args)
        texture = as_map(args[0])
        if texture is not None and op == "texture_size":
            height, width = texture.levels[0].shape[:2]
            return tuple(constant(float(n), False) for n in (width, height))
        if texture is not None:
            uv = cast(tuple[Range, ...], args[1])
            lod = cast(Range, args[2]) if len(args) > 2 else None
            return lookup(self.context, texture, uv[0], uv[1], lod)
        if op in VECTOR_BUILTINS:
            vectors = [cast(tuple[Range, ...], a) for a in args]
            flat = tuple(c for v in vectors for c in v)
            function = VECTOR_BUILTINS[op]
            return self.once(op, lambda *_: cast(Value, function(self.context, *vectors)), flat)
        return self.each(op, scalar_builtin, args)

    def call(self, e: ir.Call) -> Value:
        function = self.library.function(e.function)
        arguments = {p.name: self.expr(a) for p, a in zip(function.parameters, e.args, strict=True)}
        return Frame(self.library, self.context, function, arguments).run()

    def construct(self, e: ir.Construct) -> Value:
        parts = [self.expr(a) for a in e.args]
        if isinstance(e.type, Struct):
            return {f.name: part for f, part in zip(e.type.fields, parts, strict=True)}
        assert isinstance(e.type, Vector)
        components: list[Single] = []
        for part in parts:
            components += part if isinstance(part, tuple) else [cast(Single, part)]
        return tuple(components * e.type.size if len(components) == 1 else components)

    def converted(self, type_: Type, value: Value) -> Value:
        assert isinstance(type_, Scalar)

        def apply(context: Context, op: str, a: Single) -> Single:
            if isinstance(a, Range):
                return a if type_ == F32 else logic.to_integer(context, a, type_ == I32)
            assert isinstance(a, Whole)
            if type_ == F32:
                return logic.to_float(context, a)
            context.decided()
            return reinterpreted(a, type_ == I32)

        return self.once(f"{type_.name}()", apply, (cast(Single, value),))


_EVALUATE: dict[type, Callable[[Frame, Any], Value]] = {
    ir.Const: Frame.const,
    ir.Var: Frame.var,
    ir.Unary: Frame.unary,
    ir.Binary: Frame.binary,
    ir.Builtin: Frame.builtin,
    ir.Call: Frame.call,
    ir.Construct: Frame.construct,
    ir.Convert: Frame.convert,
    ir.Member: Frame.member,
    ir.Index: Frame.index,
    ir.Swizzle: Frame.swizzle,
    ir.Select: Frame.select,
}


def reinterpreted(a: Whole, is_signed: bool) -> Whole:
    """u32 to i32 or back: the same bits; every integer where an interval wraps."""
    if a.is_signed == is_signed:
        return a
    if a.is_point:
        exact = whole.wrapped(a.low, is_signed)
        return Whole(exact, exact, is_signed, a.cause)
    target = Whole(a.low, a.high, is_signed, a.cause)
    least, most = target.limits
    fits = (a.low >= least) & (a.high <= most)
    return Whole(np.where(fits, a.low, least), np.where(fits, a.high, most), is_signed, a.cause)
