"""A loop cut in two, a loop written out, and a statement in a loop of one turn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import Fresh

LONGEST = 8
"""Turns of a loop that is written out."""


def _rewritten(body: tuple[ir.Stmt, ...], change: Callable[[ir.For], list[ir.Stmt]]) -> tuple[ir.Stmt, ...]:
    made: list[ir.Stmt] = []
    for s in body:
        if isinstance(s, ir.If):
            made.append(replace(s, then=_rewritten(s.then, change), orelse=_rewritten(s.orelse, change)))
        elif isinstance(s, ir.For):
            made += change(replace(s, body=_rewritten(s.body, change)))
        else:
            made.append(s)
    return tuple(made)


def _split(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """for i in range(a, b) becomes the same over [a, m) and over [m, b); a limit needs a loop from 0."""

    def cut(s: ir.For) -> list[ir.Stmt]:
        if s.stop - s.start < 2 or s.limit is not None:
            return [s]
        middle = choice.randint(s.start + 1, s.stop - 1)
        return [replace(s, stop=middle), replace(s, start=middle)]

    body = _rewritten(function.body, cut)
    return None if body == function.body else Changed(replace(function, body=body))


def _unrolled(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """Each turn becomes a block of its own: a loop of one turn, whose index is written as a number.

    Turns of a loop with a limit are guarded by it.
    """

    def unroll(s: ir.For) -> list[ir.Stmt]:
        if s.stop - s.start > LONGEST:
            return [s]

        def turn(k: int) -> ir.Stmt:
            def numbered(e: ir.Expr) -> ir.Expr:
                return ir.Const(s.index_type, k) if isinstance(e, ir.Var) and e.name == s.name else e

            once = replace(s, start=0, stop=1, limit=None, body=ir.map_body(s.body, numbered))
            if s.limit is None:
                return once
            return ir.If(ir.Binary(BOOL, "<", ir.Const(s.index_type, k), s.limit), (once,), ())

        return [turn(k) for k in range(s.start, s.stop)]

    body = _rewritten(function.body, unroll)
    return None if body == function.body else Changed(replace(function, body=body))


def _one_turn(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """An assignment stands in a loop of one turn; a first assignment gets a placeholder before it."""
    fresh = Fresh(function, "turn")
    made: list[ir.Stmt] = []
    for s in function.body:
        if isinstance(s, ir.Let):
            made.append(ir.Let(s.name, s.value, True))
            made.append(ir.For(fresh(), 0, 1, (ir.Assign(s.name, s.value),)))
        elif isinstance(s, ir.Return):
            made.append(s)
        else:
            made.append(ir.For(fresh(), 0, 1, (s,)) if not _returns(s) else s)
    body = tuple(made)
    return None if body == function.body else Changed(replace(function, body=body))


def _returns(s: ir.Stmt) -> bool:
    return any(isinstance(inner, ir.Return) for inner in ir.statements((s,)))


RELATIONS = (
    SourceRelation("loop_split", "a loop cut in two", _split),
    SourceRelation("loop_unrolled", "a loop written out turn by turn", _unrolled),
    SourceRelation("one_turn_loop", "a statement in a loop of one turn", _one_turn),
)
