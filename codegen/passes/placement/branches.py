"""Branches: a choice between cheap values is a select; decided branches leave one side (see inline).

before   if c: y = a          else: y = b           (a, b cheap and without loops)
after    y = a if c else b
"""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.passes.analysis.operations import WEIGHTS, expression_operations
from codegen.passes.ssa.flow import Branch

NAME = "branches"
CHEAP = 12
"""Largest weight of what only one way needs, for a select that computes both: a few multiplications."""


def select_is_cheaper(branch: Branch, a: ir.Expr, b: ir.Expr) -> bool:
    """Whether computing both values and choosing costs about as little as branching."""
    if branch.then or branch.orelse:
        return False
    only_a, only_b = _reached(a), _reached(b)
    exclusive = [e for k, e in (only_a | only_b).items() if (k in only_a) != (k in only_b)]
    weight = sum(WEIGHTS[kind] * n for e in exclusive for kind, n in expression_operations(e).items())
    return weight <= CHEAP


def _reached(e: ir.Expr) -> dict[int, ir.Expr]:
    found: dict[int, ir.Expr] = {}
    waiting = [e]
    while waiting:
        x = waiting.pop()
        if id(x) not in found:
            found[id(x)] = x
            waiting += ir.children(x)
    return found
