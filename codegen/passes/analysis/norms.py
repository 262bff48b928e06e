"""Lengths of vectors, with room for every table's roundings; which vectors are unit vectors.

Componentwise ranges know nothing of directions: the product of two unit vectors would reach 3. Lengths do:
|a| - |b| <= |a + b| <= |a| + |b|, |a + b|^2 = |a|^2 + |b|^2 + 2 a.b, |a x b| <= |a| |b|,
|(a - b) x (a + b)| = 2 |a x b|, and a vector over its own length is no longer than 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

from codegen.ir import nodes as ir
from codegen.ir.domains import Length, Unit
from codegen.ir.types import F32, Array, Vector
from codegen.passes.ssa.values import Values, constant_components

UNIT_SLACK = 2.0**-19
"""A unit vector is one up to 1e-6 of its length, the tolerance of the cases; the next power of two."""
ROUNDING = 2.0**-22
"""Relative, of one sum or product: either neighbour is 2^-23 off; doubled for what follows."""
PRODUCT = 2.0**-19
"""Of dot and cross, relative to the larger operand's square: OpenCL's (2n - 1) 2^-23 max^2 with room."""
FLUSHED = 2.0**-120
"""Length that a vector may lose because its components are flushed to 0 below 2^-126."""
LEAST_SQUARE = 2.0**-106
"""Smallest guard of a square: two flushed ones, 2^-125 together, lengthen a vector by 2^-20 at most."""


class Bounded(Protocol):
    """Least and largest value of a component."""

    @property
    def low(self) -> float: ...

    @property
    def high(self) -> float: ...


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
            if numbers is None or len(numbers) == 1:
                return False
            return abs(math.hypot(*map(float, numbers)) - 1.0) <= 1e-6


class Lengths:
    """Least and largest lengths of float vectors; `bounds` gives the ranges of operands."""

    def __init__(self, values: Values, bounds: Callable[[ir.Expr], Sequence[Bounded]]) -> None:
        self.values = values
        self.bounds = bounds
        self._known: dict[int, tuple[float, float]] = {}

    def of(self, e: ir.Expr) -> tuple[float, float]:
        """The least and the largest length; 0 and infinity where nothing is known."""
        if not isinstance(e.type, Vector | Array) or not _holds_floats(e.type):
            return 0.0, math.inf
        if id(e) not in self._known:
            self._known[id(e)] = self._found(e)
        return self._known[id(e)]

    def product(self, a: ir.Expr, b: ir.Expr) -> tuple[float, float]:
        """The least and the largest value of dot(a, b) as any target computes it."""
        (least, most_a), (_, most_b) = self.operand(a), self.operand(b)
        slack = PRODUCT * max(most_a, most_b) ** 2
        most = most_a * most_b + slack
        return (max(least**2 - slack, 0.0) if a is b else -most), most

    def operand(self, e: ir.Expr) -> tuple[float, float]:
        """The lengths of an operand, for which the ranges of its components are known too."""
        least, most = self.of(e)
        sizes = [max(-b.low, b.high) for b in self.bounds(e)]
        return least, min(most, math.hypot(*sizes) * (1.0 + ROUNDING))

    def _found(self, e: ir.Expr) -> tuple[float, float]:
        if is_unit(self.values, e):
            return 1.0 - UNIT_SLACK, 1.0 + UNIT_SLACK
        match e:
            case ir.Var():
                known = self.values.parameters.get(e.name)
                if known is not None and isinstance(known.domain, Length):
                    return 0.0, known.domain.high * (1.0 + UNIT_SLACK)
            case ir.Index():
                return self.of(e.value)
            case ir.Construct() if isinstance(e.type, Array):
                parts = [self.of(a) for a in e.args]
                return min(least for least, _ in parts), max(most for _, most in parts)
            case ir.Unary(op="negate"):
                return self.operand(e.operand)
            case ir.Binary(op="+" | "-"):
                return _rounded(*self._sum(e))
            case ir.Binary(op="*", left=a, right=b) | ir.Binary(op="/", left=a, right=b):
                return self._scaled(e.op, a, b)
            case ir.Builtin(op="cross", args=(a, b)):
                return 0.0, self._cross(a, b)
            case ir.Construct(args=(_, _, _)) if (pair := written_cross(e)) is not None:
                return 0.0, self._cross(*pair)
            case ir.Select():
                one, other = self.operand(e.if_true), self.operand(e.if_false)
                return min(one[0], other[0]), max(one[1], other[1])
        numbers = constant_components(e)
        if numbers is None:
            return 0.0, math.inf
        size = math.hypot(*map(float, numbers))
        return size * (1.0 - ROUNDING), size * (1.0 + ROUNDING)

    def _sum(self, e: ir.Binary) -> tuple[float, float]:
        (least_a, most_a), (least_b, most_b) = self.operand(e.left), self.operand(e.right)
        least, most = max(least_a - most_b, least_b - most_a, 0.0), most_a + most_b
        if math.isfinite(most):
            between = ir.Builtin(F32, "dot", (e.left, e.right))
            (inner,) = self.bounds(self.values.intern(between))
            low, high = (inner.low, inner.high) if e.op == "+" else (-inner.high, -inner.low)
            slack = PRODUCT * max(most_a, most_b) ** 2
            shortest = least_a**2 + least_b**2 + 2.0 * low - slack
            longest = most_a**2 + most_b**2 + 2.0 * high + slack
            least = max(least, math.sqrt(max(shortest, 0.0)))
            most = min(most, math.sqrt(max(longest, 0.0)))
        return least, most

    def _scaled(self, op: str, a: ir.Expr, b: ir.Expr) -> tuple[float, float]:
        """A vector times a scalar, either way round, or over one."""
        if not isinstance(b.type, Vector):
            a, b = b, a
        if isinstance(a.type, Vector):
            return 0.0, math.inf
        if op == "*" and self._normalises(a, b):
            return 0.0, 1.0 + UNIT_SLACK
        (factor,) = self.bounds(a)
        near, far = max(factor.low, -factor.high, 0.0), max(-factor.low, factor.high)
        least, most = self.operand(b)
        if op == "/":
            if near == 0.0:
                return 0.0, math.inf
            near, far = 1.0 / far, 1.0 / near
        if not (math.isfinite(far) and math.isfinite(most)):
            return 0.0, math.inf
        return _rounded(near * least, far * most)

    def _normalises(self, factor: ir.Expr, x: ir.Expr) -> bool:
        """Whether a factor is inverse_sqrt(dot(x, x)), or that of a larger square, and none too small."""
        match factor:
            case ir.Builtin(op="inverse_sqrt", args=(ir.Builtin(op="max", args=(a, b)),)):
                guards = [guard for square, guard in ((a, b), (b, a)) if _is_square(square, x)]
                least = max((bound.low for guard in guards for bound in self.bounds(guard)), default=0.0)
                is_square = bool(guards)
            case ir.Builtin(op="inverse_sqrt", args=(a,)):
                least, is_square = 0.0, _is_square(a, x)
            case _:
                return False
        return is_square and max(least, self.operand(x)[0] ** 2) >= LEAST_SQUARE

    def _cross(self, a: ir.Expr, b: ir.Expr) -> float:
        most_a, most_b = self.operand(a)[1], self.operand(b)[1]
        slack = PRODUCT * max(most_a, most_b) ** 2
        plain = most_a * most_b + slack
        match a, b:
            case (ir.Binary(op="-", left=x, right=y), ir.Binary(op="+", left=p, right=q)) if {
                id(x),
                id(y),
            } == {id(p), id(q)}:
                return min(plain, 2.0 * self.operand(x)[1] * self.operand(y)[1] + slack)
        return plain


def _rounded(least: float, most: float) -> tuple[float, float]:
    """Lengths after one more operation on each component."""
    return max(least * (1.0 - ROUNDING) - FLUSHED, 0.0), most * (1.0 + ROUNDING) + FLUSHED


def _is_square(e: ir.Expr, x: ir.Expr) -> bool:
    return isinstance(e, ir.Builtin) and e.op == "dot" and e.args[0] is x and e.args[1] is x


def _holds_floats(type_: Vector | Array) -> bool:
    element = type_.element
    return element == F32 or (isinstance(element, Vector) and element.element == F32)


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
