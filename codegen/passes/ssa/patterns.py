"""Patterns over values, written as expressions: "x - x", "max(x, max(x, y))", "y if not c else x".

A name stands for any value, the same name for the same value; a number for that constant, in every component
of a vector. Both orders of commutative operations are tried.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, Type, Vector
from codegen.ops import BUILTINS, OPERATORS
from codegen.passes.ssa.values import COMMUTATIVE, Values, constant_components

Found = Mapping[str, ir.Expr]

_OPERATORS: dict[type, str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
    ast.And: "and", ast.Or: "or", ast.USub: "negate", ast.Invert: "~", ast.Not: "not",
}  # fmt: skip


@dataclass(frozen=True)
class Name:
    """Any value; a path of names joined by dots is one name."""

    name: str


@dataclass(frozen=True)
class Number:
    """A constant."""

    value: float | int | bool


@dataclass(frozen=True)
class Operation:
    """An operation by its name in the registry, or "select"."""

    op: str
    operands: tuple[Pattern, ...]


Pattern = Name | Number | Operation


@functools.cache
def parse(text: str) -> Pattern:
    """The pattern of a text; raises ValueError or SyntaxError for what is none."""
    return _pattern(ast.parse(text, mode="eval").body)


def _pattern(node: ast.expr) -> Pattern:
    match node:
        case ast.Name(id=name):
            return Name(name)
        case ast.Attribute():
            return Name(ast.unparse(node))
        case ast.Constant(value=bool() | int() | float() as number):
            return Number(number)
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as number)):
            return Number(-number)
        case ast.BinOp(left=a, op=op, right=b) | ast.Compare(left=a, ops=[op], comparators=[b]):
            return Operation(_OPERATORS[type(op)], (_pattern(a), _pattern(b)))
        case ast.BoolOp(op=op, values=[a, b]):
            return Operation(_OPERATORS[type(op)], (_pattern(a), _pattern(b)))
        case ast.UnaryOp(op=op, operand=a):
            return Operation(_OPERATORS[type(op)], (_pattern(a),))
        case ast.IfExp(test=c, body=a, orelse=b):
            return Operation("select", (_pattern(c), _pattern(a), _pattern(b)))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
            return Operation(name, tuple(map(_pattern, args)))
        case _:
            raise ValueError(f"no pattern: {ast.unparse(node)}")


def names(pattern: Pattern) -> set[str]:
    """The names in a pattern."""
    if isinstance(pattern, Operation):
        return {name for operand in pattern.operands for name in names(operand)}
    return {pattern.name} if isinstance(pattern, Name) else set()


def operation(e: ir.Expr) -> str | None:
    """The operation of a value, in the words of patterns; None where patterns have no word."""
    if isinstance(e, ir.Binary | ir.Builtin | ir.Unary):
        return e.op
    return "select" if isinstance(e, ir.Select) else None


Outline = tuple[tuple[str, ...], tuple[int, ...]]
"""What the operands of a value are, and of each the first operand that is the same value."""

_WRITTEN = {0.0: "0", 1.0: "1", -1.0: "-1"}
"""The numbers that identities name: few, so that values have few outlines."""


def outlines(e: ir.Expr) -> tuple[Outline, ...]:
    """What the operands of a value are, an operation, a number or "", in each order that is tried."""
    parts = ir.children(e)
    words = tuple([_word(x) for x in parts])
    if len(parts) == 2:
        alike: tuple[int, ...] = (0, 0) if parts[0] is parts[1] else (0, 1)
    else:
        numbers = [id(x) for x in parts]
        alike = tuple([numbers.index(number) for number in numbers])
    given = words, alike
    return (given, (words[::-1], alike)) if operation(e) in COMMUTATIVE else (given,)


def _word(e: ir.Expr) -> str:
    numbers = constant_components(e)
    if numbers is None:
        return operation(e) or ""
    return _number_word(numbers[0]) if all(x == numbers[0] for x in numbers) else "number"


def _number_word(x: float | int | bool) -> str:
    return _WRITTEN.get(x, "number")


def may_match(pattern: Operation, of: tuple[Outline, ...]) -> bool:
    """Whether a value with these outlines may fit a pattern: a quick look before `match`."""
    wanted = [
        p.op if isinstance(p, Operation) else _number_word(p.value) if isinstance(p, Number) else ""
        for p in pattern.operands
    ]
    firsts = [pattern.operands.index(p) if isinstance(p, Name) else k for k, p in enumerate(pattern.operands)]
    return any(
        all(p in ("", x) for p, x in zip(wanted, words, strict=False))
        and all(alike[k] == alike[first] for k, first in enumerate(firsts))
        for words, alike in of
    )


def match(pattern: Pattern, e: ir.Expr, found: Found | None = None) -> Iterator[dict[str, ir.Expr]]:
    """Every way in which a value fits a pattern: name -> value."""
    if isinstance(pattern, Name):
        known = None if found is None else found.get(pattern.name)
        if known is None or known is e:
            yield {**(found or {}), pattern.name: e}
    elif isinstance(pattern, Number):
        if _is_number(e, pattern.value):
            yield dict(found or {})
    elif operation(e) == pattern.op:
        given = ir.children(e)
        if len(given) == len(pattern.operands):
            yield from _all(pattern.operands, given, found or {})
            if pattern.op in COMMUTATIVE:
                yield from _all(pattern.operands, given[::-1], found or {})


def _is_number(e: ir.Expr, number: float | int | bool) -> bool:
    numbers = constant_components(e)
    return numbers is not None and all(
        x == number and isinstance(x, bool) == isinstance(number, bool) for x in numbers
    )


def _all(
    patterns: tuple[Pattern, ...], given: tuple[ir.Expr, ...], bound: Found
) -> Iterator[dict[str, ir.Expr]]:
    if not patterns:
        yield dict(bound)
        return
    for found in match(patterns[0], given[0], bound):
        yield from _all(patterns[1:], given[1:], found)


def make(pattern: Pattern, found: Found, values: Values, type_: Type) -> ir.Expr:
    """The value that a pattern describes; numbers and scalars widen to `type_` where it is a vector."""

    def build(p: Pattern, wanted: Type) -> ir.Expr:
        if isinstance(p, Name):
            return found[p.name]
        if isinstance(p, Number):
            return values.number(p.value, wanted)
        if p.op == "select":
            c, a, b = p.operands
            sides = build(a, wanted), build(b, wanted)
            return values.build(ir.Select(sides[0].type, build(c, BOOL), *sides))
        made = [None if isinstance(x, Number) else build(x, wanted) for x in p.operands]
        beside = next((x.type for x in made if x is not None), wanted)
        parts = zip(p.operands, made, strict=True)
        return apply(values, p.op, tuple(build(x, beside) if m is None else m for x, m in parts))

    return values.splat(build(pattern, type_), type_)


def apply(values: Values, op: str, operands: tuple[ir.Expr, ...]) -> ir.Expr:
    """The value of an operation by name, of the type that the registry gives it."""
    row = BUILTINS[op] if op in BUILTINS else OPERATORS[op]
    type_ = row.result(tuple(x.type for x in operands))
    if type_ is None:  # a scalar beside a vector
        wider: Type = next((x.type for x in operands if isinstance(x.type, Vector)), F32)
        operands = tuple(values.splat(x, wider) for x in operands)
        type_ = row.result(tuple(x.type for x in operands))
    if type_ is None:
        raise ValueError(f"{op} has no such operands")
    if op in BUILTINS:
        return values.build(ir.Builtin(type_, op, operands))
    if len(operands) == 1:
        return values.build(ir.Unary(type_, op, operands[0]))
    return values.build(ir.Binary(type_, op, *operands))
