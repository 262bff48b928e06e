"""+ 0 and * 1 with numbers that only the device learns, so that no compiler may drop them."""

from __future__ import annotations

from collections.abc import Callable

from codegen.ir import nodes as ir
from codegen.ir.types import F32, Vector
from codegen.library import Library
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import changed_body, with_parameter

SHARE = 0.5
"""Of the float operations of a function, how many are wrapped."""


def _wrapped(
    op: str, parameter: str, value: float
) -> Callable[[ir.Function, Library, Choice], Changed | None]:
    def apply(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
        neutral = ir.Var(F32, parameter)

        def wrap(e: ir.Expr) -> ir.Expr:
            if not isinstance(e, ir.Binary | ir.Builtin | ir.Unary | ir.Select) or not choice.chance(SHARE):
                return e
            if e.type == F32:
                return ir.Binary(F32, op, e, neutral)
            if isinstance(e.type, Vector) and e.type.element == F32:
                other = neutral if op == "*" else ir.Construct(e.type, (neutral,))
                return ir.Binary(e.type, op, e, other)
            return e

        changed = changed_body(function, wrap)
        return (
            None
            if changed is None
            else Changed(with_parameter(changed, parameter, value), {parameter: value})
        )

    return apply


RELATIONS = (
    SourceRelation(
        "opaque_zero", "x + 0 for x, with a 0 read at run time", _wrapped("+", "opaque_zero", 0.0)
    ),
    SourceRelation("opaque_one", "x * 1 for x, with a 1 read at run time", _wrapped("*", "opaque_one", 1.0)),
)
