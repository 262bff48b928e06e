"""Random expressions of a wanted type, as Python's own tree.

Known benign differences are kept out by construction: divisors stay off 0, arguments of roots and
logarithms positive, those of exponentials and of conversions to integers bounded, shifts below 32, and i32
far from overflow.
"""

from __future__ import annotations

import ast

from codegen.ir.types import BOOL, F32, I32, U32, UVEC2, UVEC3, VEC2, VEC3, Scalar, Struct, Type, Vector
from conformance.fuzz.choices import FLOATS, WORDS_U32, Choice, binary, call, name, number
from conformance.fuzz.floats import make_float
from conformance.fuzz.scope import Scope

UVECTORS = (UVEC2, UVEC3)
LARGEST_CONVERTED = 1.0e6
"""Floats are brought into this range before they become integers."""
SPLITS = {
    2: ([1], [1, 1]),
    3: ([1], [1, 1, 1], [2, 1], [1, 2]),
    4: ([1], [1, 1, 1, 1], [2, 2], [3, 1], [1, 2, 1]),
}
"""Sizes of what a vector is made of."""


class Expressions:
    """Makes expressions over what a scope sees."""

    def __init__(self, choice: Choice, scope: Scope) -> None:
        self.choice = choice
        self.scope = scope

    def make(self, type_: Type, depth: int) -> ast.expr:
        """An expression of the type; `depth` bounds its height."""
        if depth <= 0 or self.choice.chance(0.15):
            return self.leaf(type_)
        if self.choice.chance(0.06):
            found = self.helper(type_, depth)
            if found is not None:
                return found
        if not isinstance(type_, Struct) and self.choice.chance(0.07):
            return ast.IfExp(
                self.make(BOOL, depth - 1), self.make(type_, depth - 1), self.make(type_, depth - 1)
            )
        if isinstance(type_, Struct):
            return self.struct(type_, depth)
        if type_ == BOOL:
            return self.truth(depth)
        if type_ == I32:
            return self.signed(depth)[0]
        if type_ in (U32, *UVECTORS):
            return self.unsigned(type_, depth)
        return self.float(type_, depth)

    def leaf(self, type_: Type) -> ast.expr:
        """A visible name, a part of one, or a literal."""
        locals_ = self.scope.of(type_)
        if locals_ and self.choice.chance(0.8):
            return name(self.choice.later(locals_).name)
        part = self.part(type_)
        if part is not None and self.choice.chance(0.6):
            return part
        if isinstance(type_, Struct):
            return name(self.choice.choice(locals_).name) if locals_ else self.struct(type_, 0)
        if isinstance(type_, Vector):
            return call(
                type_.name, *(self.leaf(type_.element) for _ in range(self.choice.choice((1, type_.size))))
            )
        assert isinstance(type_, Scalar), "random programs read no maps"
        return self.literal(type_)

    def literal(self, type_: Scalar) -> ast.expr:
        """A number of the type."""
        if type_ == BOOL:
            return number(self.choice.chance(0.5))
        if type_ == F32:
            return number(self.choice.choice(FLOATS) * self.choice.choice((1.0, 1.0, -1.0)))
        if type_ == I32:
            return call("i32", number(self.choice.randint(-9, 9)))
        return call("u32", number(self.choice.choice(WORDS_U32)))

    def part(self, type_: Type) -> ast.expr | None:
        """A component of a visible vector or a field of a visible struct; None where there is none."""
        options: list[tuple[str, str]] = []
        for local in self.scope.visible().values():
            if isinstance(local.type, Struct):
                options += [(local.name, f.name) for f in local.type.fields if f.type == type_]
            elif isinstance(local.type, Vector):
                element, size = (type_.element, type_.size) if isinstance(type_, Vector) else (type_, 1)
                if local.type.element == element:
                    letters = "".join(self.choice.choice("xyzw"[: local.type.size]) for _ in range(size))
                    options.append((local.name, letters))
        if not options:
            return None
        owner, attribute = self.choice.choice(options)
        return ast.Attribute(name(owner), attribute, ast.Load())

    def helper(self, type_: Type, depth: int) -> ast.expr | None:
        """A call of a visible function; None where none returns the type."""
        fitting = [h for h in self.scope.helpers if h.returns == type_]
        if not fitting:
            return None
        chosen = self.choice.choice(fitting)
        return call(chosen.name, *(self.make(t, depth - 1) for t in chosen.parameters))

    def struct(self, type_: Struct, depth: int) -> ast.expr:
        """A struct made of its fields, by position or by keyword."""
        values = [self.make(f.type, depth - 1) for f in type_.fields]
        keywords = self.choice.randint(0, len(values)) if self.choice.chance(0.4) else len(values)
        named = [
            ast.keyword(f.name, v) for f, v in zip(type_.fields[keywords:], values[keywords:], strict=True)
        ]
        self.choice.shuffle(named)
        return ast.Call(name(type_.name), values[:keywords], named)

    def truth(self, depth: int) -> ast.expr:
        """A comparison or a combination of truth values."""
        kind = self.choice.one(compare=6, both=2, negate=1)
        if kind == "negate":
            return ast.UnaryOp(ast.Not(), self.make(BOOL, depth - 1))
        if kind == "both":
            values = [self.make(BOOL, depth - 1) for _ in range(self.choice.choice((2, 2, 3)))]
            return ast.BoolOp(self.choice.choice((ast.And(), ast.Or())), values)
        of: Type = self.choice.choice((F32, F32, U32, I32))
        op = self.choice.choice(("<", "<=", ">", ">=") if of == F32 else ("<", "<=", ">", ">=", "==", "!="))
        return binary(self.make(of, depth - 1), op, self.make(of, depth - 1))

    def signed(self, depth: int) -> tuple[ast.expr, int, int]:
        """An i32 and bounds of it."""
        kind = (
            self.choice.one(leaf=3, sum=4, negate=1, product=1, extreme=1, convert=1) if depth > 0 else "leaf"
        )
        if kind == "leaf":
            locals_ = self.scope.of(I32)
            if locals_ and self.choice.chance(0.8):
                local = self.choice.later(locals_)
                return name(local.name), local.least, local.most
            value = self.choice.randint(-9, 9)
            return call("i32", number(value)), value, value
        if kind == "convert":
            if self.choice.chance(0.5):
                return call("i32", binary(self.make(U32, depth - 1), "&", number(1023))), 0, 1023
            bounded = call("clamp", self.make(F32, depth - 1), number(-99.0), number(99.0))
            return call("i32", bounded), -99, 99
        a, least, most = self.signed(depth - 1)
        if kind == "negate":
            return ast.UnaryOp(ast.USub(), a), -most, -least
        b, low, high = self.signed(depth - 1 if kind != "product" else 0)
        if kind == "sum":
            if self.choice.chance(0.5):
                return binary(a, "+", b), least + low, most + high
            return binary(a, "-", b), least - high, most - low
        if kind == "product":
            ends = [x * y for x in (least, most) for y in (low, high)]
            if max(map(abs, ends)) < 2**24:
                return binary(a, "*", b), min(ends), max(ends)
        if self.choice.chance(0.5):
            return call("min", a, b), min(least, low), min(most, high)
        return call("max", a, b), max(least, low), max(most, high)

    def unsigned(self, type_: Type, depth: int) -> ast.expr:
        """A u32 or a vector of them: arithmetic modulo 2^32 and bits."""
        assert isinstance(type_, Scalar | Vector)
        kind = self.choice.one(bits=4, sum=4, invert=1, extreme=1, shift=3, quotient=2, convert=2, bound=1)
        a = self.make(type_, depth - 1)
        if kind == "bits":
            return binary(a, self.choice.choice("&|^"), self.make(type_, depth - 1))
        if kind == "invert":
            return ast.UnaryOp(ast.Invert(), a)
        if kind == "extreme":
            return call(self.choice.choice(("min", "max")), a, self.make(type_, depth - 1))
        if isinstance(type_, Vector):
            if self.choice.chance(0.3):
                return self.construct(type_, depth)
            scaled = self.choice.chance(0.3)
            b = self.make(U32 if scaled else type_, depth - 1)
            op = "*" if scaled else self.choice.choice("+-*")
            return binary(b, op, a) if self.choice.chance(0.5) else binary(a, op, b)
        if kind == "shift":
            by = binary(self.make(U32, depth - 1), "&", number(31)) if self.choice.chance(0.4) else None
            return binary(a, self.choice.choice(("<<", ">>")), by or number(self.choice.randint(0, 31)))
        if kind == "quotient":
            by = binary(self.make(U32, depth - 1), "|", number(1)) if self.choice.chance(0.5) else None
            return binary(
                a, self.choice.choice(("//", "%")), by or number(self.choice.choice((1, 2, 3, 7, 1000)))
            )
        if kind == "convert":
            return self.to_unsigned(depth)
        if kind == "bound":
            low, high = sorted(self.choice.sample(WORDS_U32, 2))
            return call("clamp", a, number(low), number(high))
        b = number(self.choice.choice(WORDS_U32)) if self.choice.chance(0.3) else self.make(U32, depth - 1)
        return binary(a, self.choice.choice("+-*"), b)

    def to_unsigned(self, depth: int) -> ast.expr:
        """A u32 from another type."""
        if self.choice.chance(0.4):
            return call("u32", self.signed(depth - 1)[0])
        if self.choice.chance(0.4):
            return call("float_to_bits", self.leaf(F32))
        return call("u32", call("clamp", self.make(F32, depth - 1), number(0.0), number(LARGEST_CONVERTED)))

    def construct(self, type_: Vector, depth: int) -> ast.expr:
        """A vector of numbers and shorter vectors."""
        sizes = self.choice.choice(
            [s for s in SPLITS[type_.size] if type_.element == F32 or 2 not in s or type_.size == 3]
        )
        vectors = {2: VEC2, 3: VEC3} if type_.element == F32 else {2: UVEC2, 3: UVEC3}
        return call(
            type_.name, *(self.make(type_.element if n == 1 else vectors[n], depth - 1) for n in sizes)
        )

    def float(self, type_: Type, depth: int) -> ast.expr:
        """A float or a vector of floats."""
        return make_float(self, type_, depth)
