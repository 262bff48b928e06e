"""Branches with their sides exchanged, and branches whose outcome only the device learns."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import with_parameter

PARAMETER = "opaque_half"
HALF = 0.5


def _exchanged(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """if c: A else: B becomes if not c: B else: A."""

    def flip(body: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
        made: list[ir.Stmt] = []
        for s in body:
            if isinstance(s, ir.If) and s.orelse:
                opposite = ir.Unary(BOOL, "not", s.condition)
                s = replace(s, condition=opposite, then=flip(s.orelse), orelse=flip(s.then))
            elif isinstance(s, ir.For):
                s = replace(s, body=flip(s.body))
            made.append(s)
        return tuple(made)

    body = flip(function.body)
    return None if body == function.body else Changed(replace(function, body=body))


def _guarded(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """The last return stands on both sides of a branch; only the side with the value is taken."""
    *before, last = function.body
    if not isinstance(last, ir.Return):
        return None
    taken = ir.Binary(BOOL, "<", ir.Var(F32, PARAMETER), ir.Const(F32, 1.0))
    branch = ir.If(taken, (last,), (ir.Return(last.value),))
    changed = replace(function, body=(*before, branch))
    return Changed(with_parameter(changed, PARAMETER, HALF), {PARAMETER: HALF})


RELATIONS = (
    SourceRelation("exchanged_branches", "if and else exchanged, the condition negated", _exchanged),
    SourceRelation("opaque_branch", "a branch whose outcome only the device learns", _guarded),
)
