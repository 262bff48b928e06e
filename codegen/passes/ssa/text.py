"""Expressions as a person reads them in a report: short, and named values by their names."""

from __future__ import annotations

from collections.abc import Callable

from codegen.ir import nodes as ir
from codegen.ir.domains import number
from codegen.ir.types import BOOL, F32

DEPTH = 4
"""Operations inside each other that are shown; what lies deeper is "..."."""


def show(e: ir.Expr, name: Callable[[ir.Expr], str | None] = lambda e: None) -> str:
    """The text of an expression; `name` names operands that need not be spelled out."""

    def operand(x: ir.Expr, depth: int) -> str:
        known = name(x)
        return known if known is not None else text(x, depth - 1)

    def enclosed(x: ir.Expr, depth: int) -> str:
        shown = operand(x, depth)
        return f"({shown})" if name(x) is None and isinstance(x, ir.Binary | ir.Select) else shown

    def text(x: ir.Expr, depth: int) -> str:
        if depth <= 0 and ir.children(x):
            return "..."
        match x:
            case ir.Const():
                if x.type == BOOL:
                    return str(x.value).lower()
                return number(float(x.value)) if x.type == F32 else str(x.value)
            case ir.Var():
                return x.name
            case ir.Unary():
                sign = {"negate": "-", "not": "not "}.get(x.op, x.op)
                return f"{sign}{enclosed(x.operand, depth)}"
            case ir.Binary():
                return f"{enclosed(x.left, depth)} {x.op} {enclosed(x.right, depth)}"
            case ir.Select():
                parts = [enclosed(c, depth) for c in (x.if_true, x.condition, x.if_false)]
                return f"{parts[0]} if {parts[1]} else {parts[2]}"
            case ir.Member():
                return f"{enclosed(x.value, depth)}.{x.name}"
            case ir.Swizzle():
                return f"{enclosed(x.value, depth)}.{x.components}"
            case ir.Index():
                return f"{enclosed(x.value, depth)}[{operand(x.index, depth)}]"
            case ir.Builtin() | ir.Call():
                called = x.op if isinstance(x, ir.Builtin) else x.function
                return f"{called}({', '.join(operand(a, depth) for a in x.args)})"
            case _:
                return f"{x.type.name}({', '.join(operand(c, depth) for c in ir.children(x))})"

    return text(e, DEPTH)
