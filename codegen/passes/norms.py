"""Upper bounds of vectors' lengths, with room for every table's roundings; which vectors are unit vectors.

Componentwise ranges know nothing of directions: the product of two unit vectors would reach 3. Lengths do:
|a + b| <= |a| + |b|, |a x b| <= |a| |b|, and |(a - b) x (a + b)| = 2 |a x b| <= 2 |a| |b|.
"""

from __future__ import annotations

import math

from codegen.ir import nodes as ir
from codegen.ir.domains import Length, Unit
from codegen.ir.types import Array, Vector
from codegen.passes.values import Values, constant_components

UNIT_SLACK = 2.0**-19
"""A unit vector is one up to 1e-6 of its length, the tolerance of the cases; the next power of two."""
ROUNDING = 2.0**-22
"""Relative, of one sum or product: either neighbour is 2^-23 off; doubled for what follows."""
PRODUCT = 2.0**-19
"""Of dot and cross, relative to the larger operand's square: OpenCL's (2n - 1) 2^-23 max^2 with room."""


def is_unit(values: Values, e: ir.Expr) -> bool:
    """Whether a vector is a unit vector up to rounding."""
    match e:
        case ir.Var():
            known = values.parameters.get(e.name)
            return known is not None and isinstance(known.domain, Unit)
        case ir.Index():
            return is_unit(values, e.value)
        case ir.Construct() if isinstance(e.type, Array):
            return all(is_unit(values, a) for a in e.args)
        case ir.Builtin(op="normalize"):
            return True
        case ir.Unary(op="negate"):
            return is_unit(values, e.operand)
        case ir.Select():
            return is_unit(values, e.if_true) and is_unit(values, e.if_false)
        case _:
            numbers = constant_components(e)
            return (
                numbers is not None
                and len(numbers) > 1
                and abs(math.hypot(*map(float, numbers)) - 1.0) <= 1e-6
            )


def norm(values: Values, e: ir.Expr) -> float:
    """An upper bound of a float vector's length; infinite where nothing is known."""
    if not isinstance(e.type, Vector) or e.type.element.name != "f32":
        return math.inf
    if is_unit(values, e):
        return 1.0 + UNIT_SLACK
    if isinstance(e, ir.Index):
        e = e.value
    match e:
        case ir.Construct() if isinstance(e.type, Array):
            return max(norm(values, a) for a in e.args)
        case ir.Var():
            known = values.parameters.get(e.name)
            if known is not None and isinstance(known.domain, Length):
                return known.domain.high * (1.0 + UNIT_SLACK)
            return math.inf
        case ir.Unary(op="negate"):
            return norm(values, e.operand)
        case ir.Binary(op="+" | "-"):
            return (norm(values, e.left) + norm(values, e.right)) * (1.0 + ROUNDING)
        case ir.Builtin(op="cross"):
            return _cross(values, *e.args)
        case ir.Construct(args=(_, _, _)) if (pair := written_cross(e)) is not None:
            return _cross(values, *pair)
        case ir.Select():
            return max(norm(values, e.if_true), norm(values, e.if_false))
        case _:
            numbers = constant_components(e)
            return math.inf if numbers is None else math.hypot(*map(float, numbers)) * (1.0 + ROUNDING)


def written_cross(e: ir.Construct) -> tuple[ir.Expr, ir.Expr] | None:
    """The operands of a cross product that is written out component by component; None for anything else."""
    found: tuple[ir.Expr, ir.Expr] | None = None
    for part, (i, j) in zip(e.args, (("y", "z"), ("z", "x"), ("x", "y")), strict=True):
        match part:
            case ir.Binary(
                op="-",
                left=ir.Binary(
                    op="*",
                    left=ir.Swizzle(value=a, components=first),
                    right=ir.Swizzle(value=b, components=second),
                ),
                right=ir.Binary(
                    op="*",
                    left=ir.Swizzle(value=c, components=third),
                    right=ir.Swizzle(value=d, components=fourth),
                ),
            ) if (first, second, third, fourth) == (i, j, j, i) and a is c and b is d:
                if found is not None and (found[0] is not a or found[1] is not b):
                    return None
                found = a, b
            case _:
                return None
    return found


def _cross(values: Values, a: ir.Expr, b: ir.Expr) -> float:
    sizes = norm(values, a), norm(values, b)
    slack = PRODUCT * max(sizes) ** 2
    plain = sizes[0] * sizes[1] + slack
    match a, b:
        case (ir.Binary(op="-", left=x, right=y), ir.Binary(op="+", left=p, right=q)) if {id(x), id(y)} == {
            id(p),
            id(q),
        }:
            return min(plain, 2.0 * norm(values, x) * norm(values, y) + slack)
    return plain


def product(values: Values, a: ir.Expr, b: ir.Expr) -> float:
    """An upper bound of |dot(a, b)| as any target computes it."""
    sizes = norm(values, a), norm(values, b)
    return sizes[0] * sizes[1] + PRODUCT * max(sizes) ** 2
