"""Every operation in a local of its own, and locals written out where they are used."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import Fresh, hoisted, variables

LARGEST = 400
"""Nodes beyond which writing out stops: it can double a program with every local."""


def _named(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """Each operation becomes a local; equal ones in one statement share it."""
    fresh = Fresh(function, "named")

    def name_parts(e: ir.Expr, before: list[ir.Stmt]) -> ir.Expr:
        seen: dict[ir.Expr, ir.Var] = {}

        def name_part(part: ir.Expr) -> ir.Expr:
            if not isinstance(part, ir.Binary | ir.Unary | ir.Builtin | ir.Call | ir.Select):
                return part
            if part not in seen:
                seen[part] = ir.Var(part.type, fresh())
                before.append(ir.Let(seen[part].name, part))
            return seen[part]

        return ir.map_expr(e, name_part)

    return Changed(replace(function, body=hoisted(function.body, name_parts)))


def _written_out(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """A local that is assigned once, from what never changes, is replaced by its expression."""
    fixed = {p.name for p in function.parameters}
    known: dict[str, ir.Expr] = {}
    made: list[ir.Stmt] = []

    def spelled(e: ir.Expr) -> ir.Expr:
        return known.get(e.name, e) if isinstance(e, ir.Var) else e

    for s in function.body:
        (changed,) = ir.map_body((s,), spelled)
        small = sum(1 for _ in ir.expressions((changed,))) <= LARGEST
        if (
            isinstance(changed, ir.Let)
            and not changed.mutable
            and small
            and set(variables(changed.value)) <= fixed
        ):
            known[changed.name] = changed.value
        else:
            made.append(changed)
    body = tuple(made)
    if not known or sum(1 for _ in ir.expressions(body)) > LARGEST:
        return None
    return Changed(replace(function, body=body))


RELATIONS = (
    SourceRelation("named_parts", "every operation in a local of its own", _named),
    SourceRelation("written_out", "locals replaced by what they stand for", _written_out),
)
