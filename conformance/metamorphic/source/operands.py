"""Operands in another order, and differences as sums: the same numbers to the last bit."""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.ir.types import F32, Vector
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import changed_body

COMMUTATIVE = frozenset({"+", "*", "&", "|", "^", "and", "or", "==", "!="})
MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}


def _commuted(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    def swap(e: ir.Expr) -> ir.Expr:
        if isinstance(e, ir.Binary) and e.op in COMMUTATIVE:
            return ir.Binary(e.type, e.op, e.right, e.left)
        if isinstance(e, ir.Binary) and e.op in MIRRORED:
            return ir.Binary(e.type, MIRRORED[e.op], e.right, e.left)
        if isinstance(e, ir.Builtin) and e.op in ("min", "max", "dot"):
            return ir.Builtin(e.type, e.op, (e.args[1], e.args[0]))
        return e

    changed = changed_body(function, swap)
    return None if changed is None else Changed(changed)


def _negated(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    def add(e: ir.Expr) -> ir.Expr:
        element = e.type.element if isinstance(e.type, Vector) else e.type
        if isinstance(e, ir.Binary) and e.op == "-" and element == F32:
            return ir.Binary(e.type, "+", e.left, ir.Unary(e.right.type, "negate", e.right))
        return e

    changed = changed_body(function, add)
    return None if changed is None else Changed(changed)


RELATIONS = (
    SourceRelation("commuted", "operands exchanged where the order does not matter", _commuted),
    SourceRelation("sums_for_differences", "a + (-b) for a - b", _negated),
)
