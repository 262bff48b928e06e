"""Components: those of a constructed vector are its operands; vectors stay whole where all parts are used.

before   vec3(a, b, c).y    vec3(v.x, v.y, v.z)    vec3(s, s, s)    array(a, b)[1]    vec3(s) + vec3(t)
after    b                  v                      vec3(s)          b                 vec3(s + t)

Structs never become values: inlining keeps them as their fields.
"""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.ir.types import Scalar, Vector
from codegen.passes.ssa.values import Rewrite, Values

NAME = "scalars"
EXACT = "exact: components are moved, nothing is computed"
ALIKE = "exact: every component is the same operation on the same operands"


def components(values: Values, e: ir.Expr) -> Rewrite | None:
    """Folds constructions and selections of components."""
    if isinstance(e, ir.Binary) and isinstance(e.type, Vector):
        alike = _alike(values, e, e.type)
        return None if alike is None else Rewrite(alike, NAME, ALIKE)
    if isinstance(e, ir.Swizzle):
        found = _chosen(values, e)
    elif isinstance(e, ir.Construct) and isinstance(e.type, Vector):
        found = _joined(values, e)
    elif isinstance(e, ir.Index) and isinstance(e.value, ir.Construct):
        found = e.value.args[int(e.index.value)] if isinstance(e.index, ir.Const) else None
    elif isinstance(e, ir.Convert) and e.operand.type == e.type:
        found = e.operand
    else:
        found = None
    return None if found is None else Rewrite(found, NAME, EXACT)


def _alike(values: Values, e: ir.Binary, type_: Vector) -> ir.Expr | None:
    """An operation on vectors whose components are all alike is one on scalars, or scales a vector."""
    left, right = _scalar(e.left), _scalar(e.right)
    if left is not None and right is not None:
        return values.splat(values.build(ir.Binary(type_.element, e.op, left, right)), type_)
    if right is not None and right is not e.right and e.op in ("*", "/"):
        return values.build(ir.Binary(type_, e.op, e.left, right))
    if left is not None and left is not e.left and e.op == "*":
        return values.build(ir.Binary(type_, e.op, left, e.right))
    return None


def _scalar(e: ir.Expr) -> ir.Expr | None:
    """A scalar, or what all components of a vector are; None where they differ."""
    if isinstance(e.type, Scalar):
        return e
    return e.args[0] if isinstance(e, ir.Construct) and len(e.args) == 1 else None


def _chosen(values: Values, e: ir.Swizzle) -> ir.Expr | None:
    of = e.value
    assert isinstance(of.type, Vector)
    if e.components == "xyzw"[: of.type.size]:
        return of
    if isinstance(of, ir.Swizzle):
        inner = "".join(of.components["xyzw".index(c)] for c in e.components)
        return values.build(ir.Swizzle(e.type, of.value, inner))
    if isinstance(of, ir.Construct):
        parts = [_part(values, of, "xyzw".index(c)) for c in e.components]
        return parts[0] if len(parts) == 1 else values.build(ir.Construct(e.type, tuple(parts)))
    return None


def _part(values: Values, of: ir.Construct, k: int) -> ir.Expr:
    if len(of.args) == 1:
        return values.component(of.args[0], k)
    for a in of.args:
        size = a.type.size if isinstance(a.type, Vector) else 1
        if k < size:
            return values.component(a, k)
        k -= size
    raise IndexError(k)


def _joined(values: Values, e: ir.Construct) -> ir.Expr | None:
    assert isinstance(e.type, Vector)
    if len(e.args) == 1:
        return e.args[0] if e.args[0].type == e.type else None
    flat = [_part(values, e, k) for k in range(e.type.size)]
    if all(a is flat[0] for a in flat):
        return values.build(ir.Construct(e.type, (flat[0],)))
    first = flat[0]
    if isinstance(first, ir.Swizzle) and all(
        isinstance(a, ir.Swizzle) and a.value is first.value for a in flat
    ):
        letters = "".join(a.components for a in flat if isinstance(a, ir.Swizzle))
        return values.build(ir.Swizzle(e.type, first.value, letters))
    if any(isinstance(a, ir.Construct) for a in e.args):
        return values.build(ir.Construct(e.type, tuple(flat)))
    return None
