"""Intervals of one operation on whole ranges, under one accuracy table; what was computed is remembered.

A value is a tuple of one-lane intervals, one for each component. Two values are the same object if and only
if they are one value, which is how x * x is known to be a square; so results are remembered by the identity
of operands, which the memory keeps alive. Tables that say the same of an operation share its results.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from codegen.intervals import TABLES, load_table, logic
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.interpreter import reinterpreted
from codegen.intervals.operations import VECTOR_BUILTINS, binary, scalar_builtin, unary
from codegen.intervals.values import Range, Single, Truth, Whole, choose
from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32, Array, Type, Vector

Bound = tuple[Single, ...]
"""The intervals of a value's components; of an array, those that hold every element's."""

MOST_REMEMBERED = 200_000
_memory: dict[Hashable, tuple[Bound, object]] = {}

_INHERITED = ("/", "sqrt", "inverse_sqrt", "dot", "length")
"""Operations whose rows are read for others, which inherit from them."""


def remembered(key: Hashable, make: Callable[[], Bound], alive: object = None) -> Bound:
    """The value under a key, made at its first use; `alive` is what the key names by identity."""
    found = _memory.get(key)
    if found is None:
        if len(_memory) > MOST_REMEMBERED:
            _memory.clear()
        found = _memory[key] = make(), alive
    return found[0]


@functools.cache
def transfers() -> tuple[Transfer, ...]:
    """One for each table."""
    return tuple(Transfer(name) for name in TABLES)


def signatures(e: ir.Expr) -> tuple[int, ...]:
    """The signature of the expression's operation under each table."""
    return _signatures_of(_operation(e))


class Transfer:
    """The operations of one table over ranges."""

    def __init__(self, name: str) -> None:
        self.context = Context(load_table(name), CauseBook(), 1)

    def signature(self, e: ir.Expr) -> int:
        """A number that tables share if and only if they say the same of the expression's operation."""
        return _signature_of(self.context.table.name, _operation(e))

    def apply(self, e: ir.Expr, parts: tuple[Bound, ...]) -> Bound:
        """The value of an operation on values; not for leaves and calls."""
        key = (*_words(e), self.signature(e), *map(id, parts))
        return remembered(key, lambda: self.computed(e, parts), parts)

    def computed(self, e: ir.Expr, parts: tuple[Bound, ...]) -> Bound:
        """The value of an operation, computed."""
        context = self.context
        match e:
            case ir.Unary():
                return self.each(e.op, lambda a: unary(context, e.op, a[0]), parts)
            case ir.Binary():
                return self.each(e.op, lambda a: binary(context, e.op, a[0], a[1]), parts)
            case ir.Builtin() if e.op in VECTOR_BUILTINS:
                context.operation = e.op
                found = VECTOR_BUILTINS[e.op](context, *cast(tuple[tuple[Range, ...], ...], parts))
                return found if isinstance(found, tuple) else (found,)
            case ir.Builtin():
                return self.each(e.op, lambda a: scalar_builtin(context, e.op, *a), parts)
            case ir.Construct() if isinstance(e.type, Array):
                return tuple(functools.reduce(_either, column) for column in zip(*parts, strict=True))
            case ir.Index():
                return tuple(_either(s, s) for s in parts[0])  # another number may name another element
            case ir.Construct() if isinstance(e.type, Vector):
                flat = tuple(s for p in parts for s in p)
                return flat * e.type.size if len(flat) == 1 else flat
            case ir.Convert():
                return (self.converted(e.type, parts[0][0]),)
            case ir.Swizzle():
                return tuple(parts[0]["xyzw".index(c)] for c in e.components)
            case ir.Select():
                condition = parts[0][0]
                assert isinstance(condition, Truth)
                return cast(Bound, choose(condition, parts[1], parts[2]))
            case _:
                raise TypeError(type(e).__name__)

    def each(self, op: str, apply: Callable[[Bound], Single], parts: tuple[Bound, ...]) -> Bound:
        """An operation component by component."""
        self.context.operation = op
        size = max(map(len, parts))
        columns = [p * size if len(p) == 1 else p for p in parts]
        return tuple(apply(components) for components in zip(*columns, strict=True))

    def converted(self, type_: Type, a: Single) -> Single:
        """A conversion between scalars."""
        if isinstance(a, Range):
            return a if type_ == F32 else logic.to_integer(self.context, a, type_ == I32)
        assert isinstance(a, Whole)
        return logic.to_float(self.context, a) if type_ == F32 else reinterpreted(a, type_ == I32)


def _operation(e: ir.Expr) -> str:
    return e.op if isinstance(e, ir.Unary | ir.Binary | ir.Builtin) else "cast"


def _words(e: ir.Expr) -> tuple[str, ...]:
    """What tells one operation from another, operands aside."""
    detail = e.components if isinstance(e, ir.Swizzle) else ""
    return type(e).__name__, _operation(e), detail, e.type.name


@dataclass(frozen=True)
class _Said:
    """What a table says of an operation and of those that it may inherit from, as text."""

    text: str


_numbers: dict[_Said, int] = {}


@functools.cache
def _signature_of(name: str, operation: str) -> int:
    table = load_table(name)
    shown = [table.rounding, str(table.flush), str(table.fused)]
    for each in (operation, *_INHERITED):
        if each in table.rows:
            row = table.row(each)
            shown.append(repr((row.accuracy, row.magnitude, row.reciprocal, row.zero, row.normal)))
    return _numbers.setdefault(_Said("\n".join(shown)), len(_numbers))


@functools.cache
def _signatures_of(operation: str) -> tuple[int, ...]:
    return tuple(_signature_of(name, operation) for name in TABLES)


def _either(a: Single, b: Single) -> Single:
    """A value that is one of two, told apart from both."""
    both = Truth(np.array([True]), np.array([True]))
    if isinstance(a, Truth):
        assert isinstance(b, Truth)
        return Truth(a.true | b.true, a.false | b.false)
    if a is b:
        return replace(a)
    found = choose(both, a, b)
    assert isinstance(found, Range | Whole)
    return found
