"""Operations on vectors taken apart into operations on their components."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir import nodes as ir
from codegen.ir.types import Vector
from codegen.ops import BUILTINS

GEOMETRIC = frozenset({"dot", "cross", "length", "normalize"})
COMPONENTWISE = frozenset(BUILTINS) - GEOMETRIC - {"lookup", "lookup_level", "texture_size"}


def componentwise(function: ir.Function) -> ir.Function:
    """The function with every vector operation component by component, inner products as sums."""
    return replace(function, body=ir.map_body(function.body, _scalar))


def without_cross(e: ir.Expr) -> ir.Expr:
    """cross(a, b) as differences of products; any other expression as it is."""
    if not (isinstance(e, ir.Builtin) and e.op == "cross" and isinstance(e.type, Vector)):
        return e
    a, b = e.args
    number = e.type.element

    def product(i: int, j: int) -> ir.Expr:
        return ir.Binary(number, "*", _component(a, i), _component(b, j))

    pairs = ((1, 2), (2, 0), (0, 1))
    return ir.Construct(e.type, tuple(ir.Binary(number, "-", product(i, j), product(j, i)) for i, j in pairs))


def _component(e: ir.Expr, k: int) -> ir.Expr:
    """The k-th component; of a number, the number."""
    if not isinstance(e.type, Vector):
        return e
    if isinstance(e, ir.Construct) and all(not isinstance(a.type, Vector) for a in e.args):
        return e.args[k if len(e.args) > 1 else 0]
    return ir.Swizzle(e.type.element, e, "xyzw"[k])


def _scalar(e: ir.Expr) -> ir.Expr:
    if not isinstance(e.type, Vector):
        return _sum(e)
    parts = ir.children(e)
    match e:
        case ir.Binary():
            made = [
                ir.Binary(e.type.element, e.op, _component(e.left, k), _component(e.right, k))
                for k in range(e.type.size)
            ]
            return ir.Construct(e.type, tuple(made))
        case ir.Unary():
            return ir.Construct(
                e.type,
                tuple(ir.Unary(e.type.element, e.op, _component(e.operand, k)) for k in range(e.type.size)),
            )
        case ir.Builtin() if e.op in COMPONENTWISE:
            columns = [tuple(_component(a, k) for a in parts) for k in range(e.type.size)]
            return ir.Construct(e.type, tuple(ir.Builtin(e.type.element, e.op, c) for c in columns))
        case _:
            return e


def _sum(e: ir.Expr) -> ir.Expr:
    """dot(a, b) as a sum of products."""
    if not (isinstance(e, ir.Builtin) and e.op == "dot"):
        return e
    a, b = e.args
    assert isinstance(a.type, Vector)
    terms: list[ir.Expr] = [
        ir.Binary(e.type, "*", _component(a, k), _component(b, k)) for k in range(a.type.size)
    ]
    total = terms[0]
    for term in terms[1:]:
        total = ir.Binary(e.type, "+", total, term)
    return total
