"""Terms that hardly matter: an expression is replaced by one number, or a choice by one of its sides.

This covers what a dense coat hides, a factor that is nearly 1, a highlight that is nearly 0: whatever the
scene's ranges leave so little room that nobody sees it. Each candidate is the middle of the values that the
points give, or 0 or 1 where these are among them. A choice that only saves digits, or that the scene never
takes, leaves one side.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Value, arithmetic, convert_inputs
from codegen.evaluate.interpreter import Frame
from codegen.ir import nodes as ir
from codegen.ir.content import variables
from codegen.ir.types import BOOL, F32, I32
from codegen.library import Library
from codegen.scene.proof.errors import Measured, Reference, as_floats, distance

MOST = 48
"""Candidates that are tried in one function, those with the largest subtree first."""
GLANCE = 64
"""Points that show of most candidates that they lose too much."""
NUMBER = ir.Var(I32, "number of the term")
"""Of the candidate that a lane goes without; no source has such a name."""


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


def errors_without(
    library: Library, function: ir.Function, found: Sequence[Term], reference: Reference
) -> list[Measured]:
    """The error without each term over the first GLANCE points of a reference: what is too large there is too
    large. One evaluation tells all, in lanes of their own for each term."""
    if not found:
        return []
    count = min(GLANCE, reference.points.count)
    lanes = np.tile(np.arange(count), len(found))
    inputs = {p.name: np.asarray(reference.points.inputs[p.name])[lanes] for p in function.parameters}
    inputs[NUMBER.name] = np.repeat(np.arange(len(found), dtype=np.int32), count)
    each = _each_without(function, found)
    values = as_floats(evaluate(library.with_functions([each]), each.name, inputs))
    exact, single = reference.exact[:count], reference.single[:count]
    return [distance(got, exact, single) for got in np.split(values, len(found))]


def _each_without(function: ir.Function, found: Sequence[Term]) -> ir.Function:
    """The function with one more parameter: the number of the term that is replaced."""
    here: dict[int, list[int]] = {}
    for number, term in enumerate(found):
        here.setdefault(id(term.expression), []).append(number)

    def visit(e: ir.Expr) -> ir.Expr:
        made = ir.rebuild(e, tuple(map(visit, ir.children(e))))
        for number in here.get(id(e), ()):
            asked = ir.Binary(BOOL, "==", NUMBER, ir.Const(I32, number))
            made = ir.Select(e.type, asked, found[number].replacement, made)
        return made

    parameters = (*function.parameters, ir.Parameter(NUMBER.name, I32, None))
    return replace(function, parameters=parameters, body=ir.map_wholes(function.body, visit))


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
        return ir.rebuild(e, tuple(map(visit, ir.children(e))))

    return replace(function, body=ir.map_wholes(function.body, changed))
