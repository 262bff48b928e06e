"""Calls written out in the caller, and expressions moved into functions of their own."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import Struct
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import Fresh, hoisted, variables

LEAST_NODES = 4
"""Smaller expressions are not worth a function."""


def inlined(function: ir.Function, library: Library) -> ir.Function:
    """The function with every call written out whose callee is a row of assignments and a return."""
    fresh = Fresh(function, "inner")

    def expand(e: ir.Expr, before: list[ir.Stmt]) -> ir.Expr:
        e = ir.rebuild(e, tuple(expand(c, before) for c in ir.children(e)))
        if not isinstance(e, ir.Call):
            return e
        callee = inlined(library.function(e.function), library)
        *body, last = callee.body
        straight = all(isinstance(s, ir.Let | ir.Assign) for s in body)
        if not straight or not isinstance(last, ir.Return):
            return e
        names = {name: fresh() for name in [p.name for p in callee.parameters]}
        for p, argument in zip(callee.parameters, e.args, strict=True):
            before.append(ir.Let(names[p.name], argument))

        def renamed(part: ir.Expr) -> ir.Expr:
            return replace(part, name=names[part.name]) if isinstance(part, ir.Var) else part

        for s in body:
            assert isinstance(s, ir.Let | ir.Assign)
            value = ir.map_expr(s.value, renamed)
            if isinstance(s, ir.Let):
                names[s.name] = fresh()
            before.append(replace(s, name=names[s.name], value=value))
        return ir.map_expr(last.value, renamed)

    return replace(function, body=hoisted(function.body, expand))


def _inline(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    if not any(isinstance(e, ir.Call) for e in ir.expressions(function.body)):
        return None
    changed = inlined(function, library)
    return None if changed.body == function.body else Changed(changed)


def outlined(function: ir.Function, choice: Choice) -> tuple[ir.Function, ir.Function] | None:
    """An expression moved into a new function of what it reads; None where all are small."""
    options = [
        e
        for e in ir.expressions(function.body)
        if isinstance(e, ir.Binary | ir.Builtin | ir.Select)
        and sum(1 for _ in ir.walk(e)) >= LEAST_NODES
        and variables(e)
    ]
    if not options:
        return None
    chosen = choice.choice(options)
    read = variables(chosen)
    outer = replace(
        function,
        name=f"{function.name}_part",
        kind="helper",
        parameters=tuple(ir.Parameter(n, t, None) for n, t in read.items()),
        returns=chosen.type,
        body=(ir.Return(chosen),),
    )
    call = ir.Call(chosen.type, outer.name, tuple(ir.Var(t, n) for n, t in read.items()))
    body = ir.map_body(function.body, lambda e: call if e == chosen else e)
    return outer, replace(function, body=body)


def _outline(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    made = outlined(function, choice)
    if made is None or isinstance(made[0].returns, Struct):
        return None
    return Changed(made[1], {}, (made[0],))


RELATIONS = (
    SourceRelation("inlined", "a call written out in its caller", _inline),
    SourceRelation("not_inlined", "an expression moved into a function of its own", _outline),
)
