"""Random statements: assignments, branches, bounded loops, early returns."""

from __future__ import annotations

import ast
from collections.abc import Callable

from codegen.ir.types import BOOL, F32, I32, U32, UVEC3, VEC2, VEC3, VEC4, Struct, Type, Vector
from conformance.fuzz.choices import NAMES, Choice, binary, call, name, number
from conformance.fuzz.expressions import Expressions
from conformance.fuzz.scope import Local, Scope

SHALLOW, DEEP, DEEP_SHARE = 2, 4, 0.15
"""Heights of the expressions, and how often the greater one is taken."""
MOST_TRIPS = 4
LIMITED_SHARE = 0.5
"""How often a loop ends early where a parameter can end it."""
NESTING = 2
"""Blocks inside blocks."""
LOCAL_TYPES: tuple[Type, ...] = (F32, F32, F32, VEC3, VEC3, VEC2, VEC4, U32, U32, I32, BOOL, UVEC3)
AUGMENTED = {F32: "+-*", U32: "+-*&|^", VEC2: "+-*", VEC3: "+-*", VEC4: "+-*", UVEC3: "+-*&|^"}


class Statements:
    """Makes the statements of one function."""

    def __init__(self, choice: Choice, scope: Scope, returns: Type) -> None:
        self.choice = choice
        self.scope = scope
        self.returns = returns
        self.expressions = Expressions(choice, scope)

    def body(self) -> list[ast.stmt]:
        """A whole body; its last statement returns on every path."""
        made = self.block(self.choice.randint(0, 4), NESTING)
        return [*made, self.last()]

    def last(self) -> ast.stmt:
        """A return, or an if that returns on both sides."""
        if self.choice.chance(0.2):
            test = self.expressions.make(BOOL, SHALLOW)
            return ast.If(
                test, self.inside(lambda: [self.give_back()]), self.inside(lambda: [self.give_back()])
            )
        return self.give_back()

    def give_back(self) -> ast.stmt:
        return ast.Return(self.value(self.returns))

    def block(self, count: int, nesting: int) -> list[ast.stmt]:
        """Some statements, none of which returns for certain."""
        return [self.statement(nesting) for _ in range(count)]

    def inside(self, make: Callable[[], list[ast.stmt]]) -> list[ast.stmt]:
        """Statements made in a block of their own."""
        self.scope.blocks.append({})
        made = make()
        self.scope.blocks.pop()
        return made

    def statement(self, nesting: int) -> ast.stmt:
        blocks = 1.0 if nesting > 0 else 0.0
        kind = self.choice.one(
            new=5, again=3, augmented=2, branch=2 * blocks, loop=1.5 * blocks, early=0.7 * blocks
        )
        writable = [x for x in self.scope.visible().values() if x.writable]
        if kind in ("again", "augmented") and writable:
            local = self.choice.choice(writable)
            if kind == "augmented" and local.type in AUGMENTED:
                return self.augmented(local)
            return ast.Assign([name(local.name)], self.value(local.type))
        if kind == "branch":
            return self.branch(nesting)
        if kind == "loop":
            return self.loop(nesting)
        if kind == "early":
            test = self.expressions.make(BOOL, SHALLOW)
            return ast.If(
                test, self.inside(lambda: [*self.block(self.choice.randint(0, 1), 0), self.give_back()]), []
            )
        return self.new()

    def value(self, type_: Type) -> ast.expr:
        return self.expressions.make(type_, DEEP if self.choice.chance(DEEP_SHARE) else SHALLOW)

    def new(self) -> ast.stmt:
        """The first assignment of a local."""
        types = [*LOCAL_TYPES, *self.scope.structs]
        type_ = self.choice.choice(types)
        chosen = self.choice.choice(self.scope.free(NAMES))
        if type_ == I32:
            value, least, most = self.expressions.signed(SHALLOW)
            self.scope.add(Local(chosen, type_, False, least, most))
        else:
            value = self.value(type_)
            self.scope.add(Local(chosen, type_, True))
        return ast.Assign([name(chosen)], value)

    def augmented(self, local: Local) -> ast.stmt:
        """x += value; a vector may be scaled by a number."""
        op = self.choice.choice(AUGMENTED[local.type])
        scaled = op == "*" and isinstance(local.type, Vector) and self.choice.chance(0.5)
        assert not isinstance(local.type, Struct)
        type_ = local.type.element if scaled and isinstance(local.type, Vector) else local.type
        joined = binary(name(local.name), op, self.value(type_))
        assert isinstance(joined, ast.BinOp)
        return ast.AugAssign(ast.Name(local.name, ast.Store()), joined.op, joined.right)

    def branch(self, nesting: int) -> ast.stmt:
        """if, with else and elif or without."""
        test = self.expressions.make(BOOL, SHALLOW)
        then = self.inside(lambda: self.block(self.choice.randint(1, 2), nesting - 1))
        orelse: list[ast.stmt] = []
        if self.choice.chance(0.6):
            orelse = self.inside(lambda: self.block(self.choice.randint(1, 2), nesting - 1))
        return ast.If(test, then, orelse)

    def loop(self, nesting: int) -> ast.stmt:
        """for i in range(constant), or as far as a parameter says."""
        index = self.choice.choice(self.scope.free(NAMES))
        limits = [x for x in self.scope.visible().values() if x.parameter and x.type in (I32, U32)]
        limit = self.choice.choice(limits) if limits and self.choice.chance(LIMITED_SHARE) else None
        start = 0 if limit else self.choice.choice((0, 0, 0, 1, -2))
        stop = start + self.choice.randint(1, MOST_TRIPS)
        bounds = [number(stop)] if start == 0 else [number(start), number(stop)]
        if limit:
            bounds = [call("min", name(limit.name), number(stop))]

        def make() -> list[ast.stmt]:
            self.scope.add(Local(index, limit.type if limit else I32, False, start, stop - 1))
            return self.block(self.choice.randint(1, 2), nesting - 1)

        body = self.inside(make)
        return ast.For(ast.Name(index, ast.Store()), call("range", *bounds), body, [])
