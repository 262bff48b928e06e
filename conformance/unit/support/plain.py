"""Expressions computed in exact numbers, one operation after the other: what rewriting must not change.

Floats are fractions, vectors tuples; u32 counts modulo 2^32. Roots are taken of squares only.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32, U32, Vector

_BINARY: Mapping[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "//": operator.floordiv, "%": operator.mod,
    "<<": operator.lshift, ">>": operator.rshift, "&": operator.and_, "|": operator.or_, "^": operator.xor,
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq,
    "!=": operator.ne, "and": operator.and_, "or": operator.or_, "/": lambda a, b: Fraction(a) / b,
}  # fmt: skip
_BUILTIN: Mapping[str, Callable[..., Any]] = {
    "min": min, "max": max, "abs": abs, "floor": math.floor,
    "clamp": lambda x, low, high: min(max(x, low), high),
}  # fmt: skip


def value_of(e: ir.Expr, given: Mapping[str, Any]) -> Any:
    """The exact value of an expression: a number, a truth value or a tuple of components."""
    parts = [value_of(c, given) for c in ir.children(e)]
    match e:
        case ir.Const():
            return Fraction(e.value) if e.type == F32 else e.value
        case ir.Var():
            return given[e.name]
        case ir.Unary(op="negate"):
            return _each(lambda a: -a, parts)
        case ir.Unary(op="not"):
            return not parts[0]
        case ir.Unary(op="~"):
            return 2**32 - 1 - parts[0]
        case ir.Binary():
            return _wrapped(e, _each(_BINARY[e.op], parts))
        case ir.Select():
            return parts[1] if parts[0] else parts[2]
        case ir.Swizzle():
            chosen = tuple(parts[0]["xyzw".index(c)] for c in e.components)
            return chosen if len(chosen) > 1 else chosen[0]
        case ir.Construct():
            assert isinstance(e.type, Vector)
            flat = [x for p in parts for x in (p if isinstance(p, tuple) else (p,))]
            return tuple(flat * e.type.size if len(flat) == 1 else flat)
        case ir.Builtin(op="dot"):
            return sum(a * b for a, b in zip(*parts, strict=True))
        case ir.Builtin(op="cross"):
            (a, b, c), (p, q, r) = parts
            return b * r - c * q, c * p - a * r, a * q - b * p
        case ir.Builtin(op="sqrt"):
            return _each(_root, parts)
        case ir.Builtin():
            return _each(_BUILTIN[e.op], parts)
        case _:
            raise TypeError(type(e).__name__)


def _each(apply: Callable[..., Any], parts: list[Any]) -> Any:
    """An operation component by component; a scalar is every component of itself."""
    size = max((len(p) for p in parts if isinstance(p, tuple)), default=0)
    if not size:
        return apply(*parts)
    columns = [p if isinstance(p, tuple) else (p,) * size for p in parts]
    return tuple(apply(*column) for column in zip(*columns, strict=True))


def _wrapped(e: ir.Expr, found: Any) -> Any:
    if e.type == U32:
        return found % 2**32
    return (found + 2**31) % 2**32 - 2**31 if e.type == I32 else found


def _root(square: Fraction) -> Fraction:
    root = Fraction(math.isqrt(square.numerator), math.isqrt(square.denominator))
    assert root * root == square
    return root
