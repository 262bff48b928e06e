"""Products with vectors some of whose components are the constant 0: only the other components are computed.

before   dot(n, vec3(0, 0, 1))      cross(a, vec3(0, 0, 1))
after    n.z                        vec3(a.y, -a.x, 0)
"""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.ir.types import Vector
from codegen.passes.ssa.values import Rewrite, Values, constant_components

NAME = "axes"
WHY = "finite: products with 0 are 0; the sum that is left is one of the orders that targets may take"


def zero_components(values: Values, e: ir.Expr) -> Rewrite | None:
    """Expands dot and cross where an operand has zeros."""
    match e:
        case ir.Builtin(op="dot", args=(a, b)) if _has_zero(a) or _has_zero(b):
            return Rewrite(_dot(values, a, b), NAME, WHY)
        case ir.Builtin(op="cross", args=(a, b)) if _has_zero(a) or _has_zero(b):
            pairs = ((1, 2), (2, 0), (0, 1))
            parts = tuple(_minor(values, a, b, i, j) for i, j in pairs)
            return Rewrite(values.build(ir.Construct(e.type, parts)), NAME, WHY)
    return None


def _has_zero(e: ir.Expr) -> bool:
    return isinstance(e, ir.Construct) and any(constant_components(a) == (0.0,) for a in e.args)


def _dot(values: Values, a: ir.Expr, b: ir.Expr) -> ir.Expr:
    assert isinstance(a.type, Vector)
    pairs = [(values.component(a, k), values.component(b, k)) for k in range(a.type.size)]
    terms = [values.binary("*", x, y) for x, y in pairs]
    left = [t for t in terms if constant_components(t) != (0.0,)]
    if not left:
        return values.number(0.0, a.type.element)
    total = left[0]
    for term in left[1:]:
        total = values.binary("+", total, term)
    return total


def _minor(values: Values, a: ir.Expr, b: ir.Expr, i: int, j: int) -> ir.Expr:
    first = values.binary("*", values.component(a, i), values.component(b, j))
    second = values.binary("*", values.component(a, j), values.component(b, i))
    return values.binary("-", first, second)
