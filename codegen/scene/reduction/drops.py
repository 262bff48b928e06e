"""Terms that hardly matter: an expression is replaced by one number, or a choice by one of its sides.

This covers what a dense coat hides, a factor that is nearly 1, a highlight that is nearly 0: whatever the
scene's ranges leave so little room that nobody sees it. Each candidate is the middle of the values that the
points give, or 0 or 1 where these are among them. A choice that only saves digits, or that the scene never
takes, leaves one side.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from codegen.evaluate.arrays import Value, arithmetic, convert_inputs
from codegen.evaluate.interpreter import Frame
from codegen.ir import nodes as ir
from codegen.ir.content import variables
from codegen.ir.types import F32
from codegen.library import Library

MOST = 48
"""Candidates that are tried in one function, those with the largest subtree first."""


@dataclass(frozen=True)
class Term:
    """An expression, what may stand for it, and the values that it takes over the points."""

    expression: ir.Expr
    replacement: ir.Expr
    low: float
    high: float


class _Recorder(Frame):
    """An evaluation that notes the extremes of every scalar."""

    takes_loops_apart = False
    seen: dict[int, tuple[float, float]]

    def expr(self, e: ir.Expr) -> Value:
        value = super().expr(e)
        if e.type == F32 and not isinstance(e, ir.Const | ir.Var) and isinstance(value, np.ndarray):
            low, high = self.seen.get(id(e), (np.inf, -np.inf))
            self.seen[id(e)] = min(low, float(value.min())), max(high, float(value.max()))
        return value


def terms(library: Library, function: ir.Function, inputs: Mapping[str, Value]) -> list[Term]:
    """The candidates of a function without calls, those that stand for most operations first."""
    chosen = arithmetic("float32")
    arrays, count = convert_inputs(
        {p.name: p.type for p in function.parameters}, inputs, chosen, function.name
    )
    frame = _Recorder(library.function, chosen, function, arrays, count)
    frame.seen = {}
    with np.errstate(all="ignore"):
        frame.run()
    locals_ = {s.name: _Own.of(s.value) for s in ir.statements(function.body) if isinstance(s, ir.Let)}
    found: list[tuple[int, Term]] = []
    seen: set[int] = set()
    for e in ir.expressions(function.body):
        ends = frame.seen.get(id(e))
        if ends is None or not all(np.isfinite(ends)) or ends[0] == ends[1] == 0.0 or id(e) in seen:
            continue
        seen.add(id(e))
        size = _size(e, locals_)
        found += [(size, Term(e, ir.Const(F32, value), *ends)) for value in _numbers(*ends)]
        if isinstance(e, ir.Select):
            found += [(size, Term(e, side, *ends)) for side in (e.if_false, e.if_true)]
    found.sort(key=lambda entry: -entry[0])
    return [term for size, term in found if size > 1][:MOST]


def _numbers(low: float, high: float) -> list[float]:
    """0 and 1 where they are among the values, which simplifies more, and the middle."""
    nice = [x for x in (0.0, 1.0) if low - 1e-6 <= x <= high + 1e-6]
    return [*nice, float(np.float32(0.5 * (low + high)))]


@dataclass(frozen=True)
class _Own:
    """Operations of an expression itself, and the locals that it names."""

    operations: int
    names: frozenset[str]

    @staticmethod
    def of(e: ir.Expr) -> _Own:
        count = sum(isinstance(x, ir.Unary | ir.Binary | ir.Builtin | ir.Select) for x in ir.walk(e))
        return _Own(count, frozenset(variables(e)))


def _size(e: ir.Expr, locals_: Mapping[str, _Own]) -> int:
    """Operations below an expression, each local once."""
    own = _Own.of(e)
    total, seen, waiting = own.operations, set(own.names), list(own.names)
    while waiting:
        inner = locals_.get(waiting.pop())
        if inner is not None:
            total += inner.operations
            waiting += inner.names - seen
            seen |= inner.names
    return total


Parts = Mapping[int, frozenset[int]]
"""Id of a statement's expression -> ids of all that is in it."""


def parts_of(function: ir.Function) -> Parts:
    """What each expression of a function holds; for as long as the function lives."""
    found: dict[int, frozenset[int]] = {}
    for s in ir.statements(function.body):
        for e in _own(s):
            found[id(e)] = frozenset(map(id, ir.walk(e)))
    return found


def _own(s: ir.Stmt) -> tuple[ir.Expr, ...]:
    """The expressions of a statement that are not in statements within it."""
    match s:
        case ir.If():
            return (s.condition,)
        case ir.For():
            return () if s.limit is None else (s.limit,)
        case _:
            return (s.value,)


def without(function: ir.Function, term: Term, holds: Parts) -> ir.Function:
    """The function with the replacement in the expression's place; `holds` as `parts_of` gives it."""
    target = term.expression

    def changed(e: ir.Expr) -> ir.Expr:
        return visit(e) if id(target) in holds[id(e)] else e

    def visit(e: ir.Expr) -> ir.Expr:
        if e is target:
            return term.replacement
        parts = ir.children(e)
        made = tuple(map(visit, parts))
        return ir.rebuild(e, made) if any(a is not b for a, b in zip(made, parts, strict=True)) else e

    def block(body: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
        made: list[ir.Stmt] = []
        for s in body:
            match s:
                case ir.If():
                    condition = changed(s.condition)
                    made.append(replace(s, condition=condition, then=block(s.then), orelse=block(s.orelse)))
                case ir.For():
                    limit = None if s.limit is None else changed(s.limit)
                    made.append(replace(s, limit=limit, body=block(s.body)))
                case _:
                    value = changed(s.value)
                    made.append(s if value is s.value else replace(s, value=value))
        return tuple(made)

    return replace(function, body=block(function.body))
