"""Conditional expressions whose condition is constant: only the chosen side is kept.

before   a if 1.0 > 0.5 else b
after    a

WGSL compilers evaluate select() of constants themselves, and naga 29.0.3 panics where a vector among them is
made of vectors: select(vec3(vec2(1.0), 1.0), vec3(3.0), true).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from codegen.ir import nodes as ir
from codegen.ir.content import is_constant
from codegen.ir.types import BOOL
from codegen.ir.unit import Unit


def drop_decided(unit: Unit) -> Unit:
    """The unit without conditional expressions whose condition holds no variable and no call."""
    return Unit(tuple(map(_function, unit.functions)), unit.structs)


def _function(f: ir.Function) -> ir.Function:
    def chosen(e: ir.Expr) -> ir.Expr:
        if not isinstance(e, ir.Select) or not is_constant(e.condition):
            return e
        return e.if_true if _holds(e.condition, f) else e.if_false

    return replace(f, body=ir.map_body(f.body, chosen))


def _holds(condition: ir.Expr, of: ir.Function) -> bool:
    """A condition's value, computed in float32 as the IR defines it."""
    if isinstance(condition, ir.Const):
        return bool(condition.value)
    from codegen.evaluate import evaluate  # it imports passes itself

    alone = replace(of, parameters=(), returns=BOOL, body=(ir.Return(condition),))
    value: Any = evaluate(_Alone(alone), of.name, {})  # type: ignore[arg-type]  # looks up one function
    return bool(value[0])


@dataclass(frozen=True)
class _Alone:
    """A library of one function."""

    found: ir.Function

    def function(self, name: str) -> ir.Function:
        return self.found
