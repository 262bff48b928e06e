"""Statements that do not depend on each other, exchanged."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import values_of


def reads(s: ir.Stmt) -> set[str]:
    """Names that a statement reads."""
    return {e.name for e in values_of(s) if isinstance(e, ir.Var)}


def writes(s: ir.Stmt) -> set[str]:
    """Names that a statement gives a value."""
    return {inner.name for inner in ir.statements((s,)) if isinstance(inner, ir.Let | ir.Assign | ir.For)}


def independent(a: ir.Stmt, b: ir.Stmt) -> bool:
    """Whether two statements may change places; one that may return stays."""
    if any(isinstance(inner, ir.Return) for inner in ir.statements((a, b))):
        return False
    return not (writes(a) & (reads(b) | writes(b)) or writes(b) & reads(a))


def reordered(body: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
    """Neighbours exchanged wherever they may be, each statement moving at most one place up."""
    made = list(body)
    k = 0
    while k + 1 < len(made):
        if independent(made[k], made[k + 1]):
            made[k], made[k + 1] = made[k + 1], made[k]
            k += 1
        k += 1
    return tuple(made)


def _apply(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    body = reordered(function.body)
    return None if body == function.body else Changed(replace(function, body=body))


RELATIONS = (SourceRelation("reordered", "independent statements in another order", _apply),)
