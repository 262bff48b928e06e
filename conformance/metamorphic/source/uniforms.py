"""Literals read at run time instead of written in the text."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import with_parameter


def _apply(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    names: dict[float, str] = {}

    def read(e: ir.Expr) -> ir.Expr:
        if not (isinstance(e, ir.Const) and e.type == F32):
            return e
        name = names.setdefault(float(e.value), f"number_{len(names)}")
        return ir.Var(F32, name)

    body = ir.map_body(function.body, read)
    if not names:
        return None
    changed = replace(function, body=body)
    for value, name in names.items():
        changed = with_parameter(changed, name, value)
    return Changed(changed, {name: value for value, name in names.items()})


RELATIONS = (SourceRelation("uniform_literals", "numbers read at run time instead of literals", _apply),)
