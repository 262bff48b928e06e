"""What constants decide: only the chosen side of a conditional expression is kept, and u32(-1) is its value.

before   a if 1.0 > 0.5 else b    n ^ u32(-1)
after    a                        n ^ 4294967295

WGSL compilers evaluate select() of constants themselves, and naga 29.0.3 panics where a vector among them is
made of vectors: select(vec3(vec2(1.0), 1.0), vec3(3.0), true). They refuse u32(-1), whose -1 has no type,
and 2147483648u << 31u, whose bits are shifted out: what integers are left with constants is computed here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from codegen.ir import nodes as ir
from codegen.ir.content import is_constant
from codegen.ir.types import I32, U32
from codegen.ir.unit import Unit

LEAST = -(2**31)
"""Has no literal in C: its sign is an operator."""


def drop_decided(unit: Unit) -> Unit:
    """The unit without conditional expressions and conversions to u32 that hold no variable and no call."""
    return Unit(tuple(map(_function, unit.functions)), unit.structs)


def _function(f: ir.Function) -> ir.Function:
    def settled(e: ir.Expr) -> ir.Expr:
        match e:
            case ir.Select() if is_constant(e.condition):
                return e.if_true if _value(e.condition, f) else e.if_false
            case ir.Convert() if e.type == U32 and e.operand.type == I32 and is_constant(e.operand):
                return ir.Const(U32, int(_value(e, f)))
            case ir.Binary() if e.type in (I32, U32) and is_constant(e):
                value = int(_value(e, f))
                return e if value == LEAST else ir.Const(e.type, value)
        return e

    return replace(f, body=ir.map_body(f.body, settled))


def _value(e: ir.Expr, of: ir.Function) -> Any:
    """The value of a constant expression, computed in float32 as the IR defines it."""
    from codegen.evaluate import evaluate  # it imports passes itself

    alone = replace(of, parameters=(), returns=e.type, body=(ir.Return(e),))
    found: Any = evaluate(_Alone(alone), of.name, {})  # type: ignore[arg-type]  # looks up one function
    return found[0]


@dataclass(frozen=True)
class _Alone:
    """A library of one function."""

    found: ir.Function

    def function(self, name: str) -> ir.Function:
        return self.found
