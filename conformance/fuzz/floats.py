"""Random expressions of floats and float vectors."""

from __future__ import annotations

import ast
from typing import Protocol

from codegen.ir.types import F32, I32, U32, VEC2, VEC3, VEC4, Type, Vector
from conformance.fuzz.choices import Choice, binary, call, number

VECTORS = (VEC2, VEC3, VEC4)
EXPONENT_BITS, FRACTION_BITS = 0x3F800000, 0x007FFFFF
"""With these bits an integer becomes a float in [1, 2)."""


class Maker(Protocol):
    """What makes the parts of an expression: conformance.fuzz.expressions.Expressions."""

    choice: Choice

    def make(self, type_: Type, depth: int) -> ast.expr:
        """An expression of any type."""

    def construct(self, type_: Vector, depth: int) -> ast.expr:
        """A vector of numbers and shorter vectors."""


def make_float(of: Maker, type_: Type, depth: int) -> ast.expr:
    """An expression of type f32, vec2, vec3 or vec4."""
    choice = of.choice
    kind = choice.one(sum=5, product=5, quotient=2, negate=1, simple=3, bounded=4, special=3)
    if kind in ("sum", "product"):
        return _arithmetic(of, type_, depth, choice.choice("+-") if kind == "sum" else "*")
    if kind == "negate":
        return ast.UnaryOp(ast.USub(), of.make(type_, depth - 1))
    if kind == "quotient":
        by = F32 if isinstance(type_, Vector) and choice.chance(0.5) else type_
        return binary(of.make(type_, depth - 1), "/", _positive(of, by, depth - 1))
    if kind == "simple":
        name = choice.choice(("abs", "floor", "min", "max"))
        count = 2 if name in ("min", "max") else 1
        return call(name, *(of.make(type_, depth - 1) for _ in range(count)))
    if kind == "bounded":
        return _bounded(of, type_, depth)
    return _vector(of, type_, depth) if isinstance(type_, Vector) else _scalar(of, depth)


def _arithmetic(of: Maker, type_: Type, depth: int, op: str) -> ast.expr:
    a = of.make(type_, depth - 1)
    if op == "*" and isinstance(type_, Vector) and of.choice.chance(0.5):
        scalar = of.make(F32, depth - 1)
        return binary(scalar, op, a) if of.choice.chance(0.5) else binary(a, op, scalar)
    return binary(a, op, of.make(type_, depth - 1))


def _filled(type_: Type, value: float) -> ast.expr:
    """The number, or a vector of it."""
    return call(type_.name, number(value)) if isinstance(type_, Vector) else number(value)


def _positive(of: Maker, type_: Type, depth: int) -> ast.expr:
    """Something that stays off 0."""
    inner = call("abs", of.make(type_, depth - 1))
    if of.choice.chance(0.5):
        return binary(inner, "+", _filled(type_, of.choice.choice((0.5, 1.0, 0.125))))
    return call("max", inner, _filled(type_, of.choice.choice((0.25, 1.0))))


def _bounded(of: Maker, type_: Type, depth: int) -> ast.expr:
    """A function whose argument is kept where it is defined and promised."""
    name = of.choice.choice(
        ("sqrt", "inverse_sqrt", "exp", "exp2", "log", "log2", "sin", "cos", "atan2", "clamp")
    )
    x = of.make(type_, depth - 1)

    def clamped(low: float, high: float) -> ast.expr:
        return call("clamp", x, _filled(type_, low), _filled(type_, high))

    match name:
        case "sqrt":
            return call(name, call("abs", x))
        case "inverse_sqrt" | "log" | "log2":
            return call(name, _positive(of, type_, depth))
        case "exp" | "exp2":
            return call(name, clamped(-10.0, 10.0))
        case "sin" | "cos":
            return call(name, clamped(-3.0, 3.0))
        case "atan2":
            return call(name, x, _positive(of, type_, depth))
        case _:
            return clamped(-1.0, of.choice.choice((-1.0, 0.0, 1.0, 2.5)))


def _scalar(of: Maker, depth: int) -> ast.expr:
    kind = of.choice.one(dot=2, length=2, convert=3, bits=1)
    if kind == "convert":
        source = of.choice.choice((U32, I32))
        return call("f32", of.make(source, depth - 1))
    if kind == "bits":
        fraction = binary(of.make(U32, depth - 1), "&", number(FRACTION_BITS))
        return call("bits_to_float", binary(fraction, "|", number(EXPONENT_BITS)))
    vector = of.choice.choice(VECTORS)
    return call(kind, *(of.make(vector, depth - 1) for _ in range(2 if kind == "dot" else 1)))


def _vector(of: Maker, type_: Vector, depth: int) -> ast.expr:
    kind = of.choice.one(construct=4, normalize=1, cross=2 if type_ == VEC3 else 0)
    if kind == "construct":
        return of.construct(type_, depth)
    if kind == "cross":
        return call("cross", of.make(VEC3, depth - 1), of.make(VEC3, depth - 1))
    return call("normalize", _positive(of, type_, depth))
