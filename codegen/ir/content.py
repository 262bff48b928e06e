"""What an expression is made of."""

from __future__ import annotations

import math
from collections.abc import Iterable

from codegen.ir import nodes as ir


def variables(e: ir.Expr) -> tuple[str, ...]:
    """The names of an expression's variables, each once, in the order of evaluation."""
    return tuple(dict.fromkeys(x.name for x in ir.walk(e) if isinstance(x, ir.Var)))


def is_constant(e: ir.Expr) -> bool:
    """Whether an expression is made of literals and built-ins alone, so that a compiler computes it."""
    return not isinstance(e, ir.Var | ir.Call) and all(map(is_constant, ir.children(e)))


def zeros(nodes: Iterable[ir.Expr]) -> tuple[bool, ...]:
    """Whether each zero among some nodes is negative. Nodes that differ in that alone are equal."""
    return tuple(math.copysign(1.0, e.value) < 0.0 for e in nodes if isinstance(e, ir.Const) and e.value == 0)
