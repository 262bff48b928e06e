"""Constant factors move outwards and meet: fewer multiplications, equal as real numbers.

Every scalar is followed as a constant times what is left of it. Products gather their constants; sums take
one out where the other side takes its inverse in for nothing; a local that is a multiple becomes what it is a
multiple of. What is left over is multiplied where the value is used.

before   y = min(8.0, 4.5 * r); y * (0.06 - 0.002 * y)      (0.5 + 0.5 * t) * 0.7
after    y = min(1.78, r); -0.04 * (y * (y - 6.7))          0.35 * (1.0 + t)

Roundings move, so a scene takes this only within its budget.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from codegen.ir import nodes as ir
from codegen.ir.types import F32, Vector
from codegen.passes.analysis.operations import operations

MOST_SUMS = 6
"""Sums of vectors up to which each number of them is tried to hand a constant on."""
SMALLEST, LARGEST = 2.0**-16, 2.0**16
"""Constants that are carried: what powers make of others may leave the numbers."""


@dataclass(frozen=True)
class Scaled:
    """factor * value."""

    factor: float
    value: ir.Expr


def gathered(function: ir.Function) -> ir.Function | None:
    """The function with its constant factors gathered; None where it has branches or loops, or none move."""
    if not all(isinstance(s, ir.Let | ir.Return) and not _mutable(s) for s in function.body):
        return None
    sums = sum(
        isinstance(e, ir.Binary) and e.op in "+-" and isinstance(e.type, Vector)
        for e in ir.expressions(function.body)
    )
    tried = [_Gathering(kept).function(function) for kept in sorted({*range(min(sums, MOST_SUMS) + 1), sums})]
    found = min(tried, key=lambda f: sum(operations(f).values()))
    return None if found.body == function.body else found


def _mutable(s: ir.Stmt) -> bool:
    return isinstance(s, ir.Let) and s.mutable


class _Gathering:
    """One walk; `factors` tells what a local stands for a multiple of.

    sums  of vectors that still hand a constant on; later ones multiply it in, on a scalar where there is one
    """

    def __init__(self, sums: int) -> None:
        self.sums = sums
        self.factors: dict[str, float] = {}

    def function(self, function: ir.Function) -> ir.Function:
        made: list[ir.Stmt] = []
        for s in function.body:
            match s:
                case ir.Let():
                    found = self.of(s.value)
                    self.factors[s.name] = found.factor
                    made.append(replace(s, value=found.value))
                case ir.Return():
                    made.append(replace(s, value=self.plain(s.value)))
        return replace(function, body=tuple(made))

    def plain(self, e: ir.Expr) -> ir.Expr:
        """The value with its constant multiplied in."""
        return _times(self.of(e))

    def of(self, e: ir.Expr) -> Scaled:
        """An expression as a constant times the rest."""
        if not _is_float(e):
            return Scaled(1.0, ir.rebuild(e, tuple(map(self.plain, ir.children(e)))))
        match e:
            case ir.Var():
                return Scaled(self.factors.get(e.name, 1.0), e)
            case ir.Const():
                return Scaled(1.0, e)
            case ir.Unary(op="negate"):
                inner = self.of(e.operand)
                return _kept(-inner.factor, inner.value)
            case ir.Binary(op="*"):
                return self.product(e)
            case ir.Binary(op="/"):
                a, b = self.of(e.left), self.of(e.right)
                return _kept(a.factor / b.factor, replace(e, left=a.value, right=b.value))
            case ir.Binary(op="+" | "-"):
                return self.sum(e)
            case ir.Builtin(op="min" | "max", args=(a, b)):
                return self.extreme(e, a, b)
            case ir.Construct(args=(a,)) if isinstance(e.type, Vector):
                inner = self.of(a)
                return Scaled(inner.factor, replace(e, args=(inner.value,)))
            case _:
                return Scaled(1.0, ir.rebuild(e, tuple(map(self.plain, ir.children(e)))))

    def product(self, e: ir.Binary) -> Scaled:
        a, b = self.of(e.left), self.of(e.right)
        factor = a.factor * b.factor
        for constant, other in ((a, b), (b, a)):
            if isinstance(constant.value, ir.Const) and other.value.type == e.type:
                return _kept(factor * float(constant.value.value), other.value)
        taken = _taking(factor, a.value), _taking(factor, b.value)
        if factor != 1.0 and taken[0] is not None:
            return Scaled(1.0, replace(e, left=taken[0], right=b.value))
        if factor != 1.0 and taken[1] is not None:
            return Scaled(1.0, replace(e, left=a.value, right=taken[1]))
        return _kept(factor, replace(e, left=a.value, right=b.value))

    def sum(self, e: ir.Binary) -> Scaled:
        a, b = self.of(e.left), self.of(e.right)
        hands_on = True
        if isinstance(e.type, Vector):
            hands_on = self.sums > 0
            self.sums -= 1
        for one, other in ((a, b), (b, a)):
            if one.factor == 1.0 or not hands_on:
                continue
            rest = _taking(other.factor / one.factor, other.value)
            if other.factor == one.factor:
                rest = other.value
            if rest is not None:
                pair = (one.value, rest) if one is a else (rest, one.value)
                return _kept(one.factor, replace(e, left=pair[0], right=pair[1]))
        return Scaled(1.0, replace(e, left=_times(a), right=_times(b)))

    def extreme(self, e: ir.Builtin, a: ir.Expr, b: ir.Expr) -> Scaled:
        one, other = self.of(a), self.of(b)
        for k, (x, y) in enumerate(((one, other), (other, one))):
            limit = _taking(y.factor / x.factor, y.value) if x.factor > 0.0 else None
            if x.factor != 1.0 and limit is not None and isinstance(y.value, ir.Const):
                pair = (x.value, limit) if k == 0 else (limit, x.value)
                return Scaled(x.factor, replace(e, args=pair))
        return Scaled(1.0, replace(e, args=(_times(one), _times(other))))


def _is_float(e: ir.Expr) -> bool:
    return e.type == F32 or (isinstance(e.type, Vector) and e.type.element == F32)


def _kept(factor: float, value: ir.Expr) -> Scaled:
    """A constant that is carried on, or multiplied here where it grows too large or too small."""
    if SMALLEST <= abs(factor) <= LARGEST:
        return Scaled(factor, value)
    return Scaled(1.0, _times(Scaled(factor, value)))


def _times(found: Scaled) -> ir.Expr:
    """The product, on the scalar where a vector is a multiple of one."""
    factor, e = found.factor, found.value
    if factor == 1.0:
        return e
    taken = _taking(factor, e)
    if taken is not None:
        return taken
    if isinstance(e, ir.Binary) and e.op == "*" and isinstance(e.type, Vector):
        for k, side in enumerate((e.left, e.right)):
            if side.type == F32:
                scaled = _times(Scaled(factor, side))
                return replace(e, right=scaled) if k else replace(e, left=scaled)
    if isinstance(e, ir.Construct) and len(e.args) == 1:
        return replace(e, args=(_times(Scaled(factor, e.args[0])),))
    number: ir.Expr = ir.Const(F32, _rounded(factor))
    if isinstance(e.type, Vector):
        number = ir.Construct(e.type, (number,))
    return ir.Binary(e.type, "*", number, e)


def _taking(factor: float, e: ir.Expr) -> ir.Expr | None:
    """The expression times a constant where that costs nothing: it goes into constants that are there."""
    match e:
        case ir.Const():
            value = _rounded(factor * float(e.value))
            return replace(e, value=value) if value == 0.0 or SMALLEST <= abs(value) <= LARGEST else None
        case ir.Construct() if isinstance(e.type, Vector):
            parts = tuple(_taking(factor, a) for a in e.args)
            found = tuple(p for p in parts if p is not None)
            return replace(e, args=found) if len(found) == len(parts) else None
        case ir.Binary(op="*"):
            left, right = _taking(factor, e.left), _taking(factor, e.right)
            if left is not None:
                return replace(e, left=left)
            return replace(e, right=right) if right is not None else None
        case ir.Binary(op="/"):
            left = _taking(factor, e.left)
            return replace(e, left=left) if left is not None else None
        case ir.Binary(op="+" | "-"):
            both = _taking(factor, e.left), _taking(factor, e.right)
            return replace(e, left=both[0], right=both[1]) if both[0] and both[1] else None
        case _:
            return None


def _rounded(x: float) -> float:
    return float(np.float32(x))
