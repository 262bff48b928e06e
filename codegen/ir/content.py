"""What an expression is made of."""

from __future__ import annotations

from codegen.ir import nodes as ir


def variables(e: ir.Expr) -> tuple[str, ...]:
    """The names of an expression's variables, each once, in the order of evaluation."""
    return tuple(dict.fromkeys(x.name for x in ir.walk(e) if isinstance(x, ir.Var)))


def is_constant(e: ir.Expr) -> bool:
    """Whether an expression is made of literals and built-ins alone, so that a compiler computes it."""
    return not isinstance(e, ir.Var | ir.Call) and all(map(is_constant, ir.children(e)))
