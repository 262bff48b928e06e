"""Conditional expressions as branches."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import Fresh, hoisted


def _apply(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """a if c else b becomes a local that holds b, and a where c is true."""
    fresh = Fresh(function, "chosen")

    def branch(e: ir.Expr, before: list[ir.Stmt]) -> ir.Expr:
        e = ir.rebuild(e, tuple(branch(c, before) for c in ir.children(e)))
        if not isinstance(e, ir.Select):
            return e
        name = fresh()
        before.append(ir.Let(name, e.if_false, True))
        before.append(ir.If(e.condition, (ir.Assign(name, e.if_true),)))
        return ir.Var(e.type, name)

    body = hoisted(function.body, branch)
    return None if body == function.body else Changed(replace(function, body=body))


RELATIONS = (SourceRelation("branched_choices", "conditional expressions as branches", _apply),)
