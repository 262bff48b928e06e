"""Patterns over values, written as expressions: "x - x", "max(x, max(x, y))", "y if not c else x".

A name stands for any value, the same name for the same value; a number for that constant, in every component
of a vector. Both orders of commutative operations are tried.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator, Mapping

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, Type, Vector
from codegen.ops import BUILTINS, OPERATORS
from codegen.passes.values import COMMUTATIVE, Values, constant_components

Found = Mapping[str, ir.Expr]

_OPERATORS: dict[type, str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
    ast.And: "and", ast.Or: "or", ast.USub: "negate", ast.Invert: "~", ast.Not: "not",
}  # fmt: skip


@functools.cache
def parse(text: str) -> ast.expr:
    """The pattern of a text; raises ValueError for what is no expression."""
    return ast.parse(text, mode="eval").body


def parts(pattern: ast.expr) -> tuple[str, tuple[ast.expr, ...]] | None:
    """The operation of a pattern and its operands; None for names and numbers."""
    if number_of(pattern) is not None:
        return None
    match pattern:
        case ast.BinOp(left=a, op=op, right=b):
            return _OPERATORS[type(op)], (a, b)
        case ast.UnaryOp(op=op, operand=a):
            return _OPERATORS[type(op)], (a,)
        case ast.Compare(left=a, ops=[op], comparators=[b]):
            return _OPERATORS[type(op)], (a, b)
        case ast.BoolOp(op=op, values=[a, b]):
            return _OPERATORS[type(op)], (a, b)
        case ast.IfExp(test=c, body=a, orelse=b):
            return "select", (c, a, b)
        case ast.Call(func=ast.Name(id=name), args=args):
            return name, tuple(args)
        case ast.Name():
            return None
        case _:
            raise ValueError(f"no pattern: {ast.unparse(pattern)}")


def number_of(pattern: ast.expr) -> float | int | bool | None:
    """The number that a pattern is, with its sign; None for anything else."""
    match pattern:
        case ast.Constant(value=bool() | int() | float() as number):
            return number
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as number)):
            return -number
        case _:
            return None


def operation(e: ir.Expr) -> str | None:
    """The operation of a value, in the words of patterns; None where patterns have no word."""
    match e:
        case ir.Unary() | ir.Binary() | ir.Builtin():
            return e.op
        case ir.Select():
            return "select"
        case _:
            return None


def match(pattern: ast.expr, e: ir.Expr, found: Found | None = None) -> Iterator[dict[str, ir.Expr]]:
    """Every way in which a value fits a pattern: name -> value."""
    bound = dict(found or {})
    if isinstance(pattern, ast.Name):
        if bound.setdefault(pattern.id, e) is e:
            yield bound
        return
    number = number_of(pattern)
    if number is not None:
        components = constant_components(e)
        if components is not None and all(x == number and _alike(x, number) for x in components):
            yield bound
        return
    op, operands = parts(pattern) or ("", ())
    given = ir.children(e)
    if operation(e) != op or len(given) != len(operands):
        return
    orders = [given, given[::-1]] if op in COMMUTATIVE else [given]
    for order in orders:
        yield from _all(operands, order, bound)


def _alike(x: float | int | bool, number: object) -> bool:
    return isinstance(x, bool) == isinstance(number, bool)


def _all(
    patterns: tuple[ast.expr, ...], given: tuple[ir.Expr, ...], bound: Found
) -> Iterator[dict[str, ir.Expr]]:
    if not patterns:
        yield dict(bound)
        return
    for found in match(patterns[0], given[0], bound):
        yield from _all(patterns[1:], given[1:], found)


def make(pattern: ast.expr, found: Found, values: Values, type_: Type) -> ir.Expr:
    """The value that a pattern describes; numbers and scalars widen to `type_` where it is a vector."""

    def build(p: ast.expr, wanted: Type) -> ir.Expr:
        if isinstance(p, ast.Name):
            return found[p.id]
        number = number_of(p)
        if number is not None:
            return values.number(number, wanted)
        op, operands = parts(p) or ("", ())
        if op == "select":
            c, a, b = operands
            sides = build(a, wanted), build(b, wanted)
            return values.build(ir.Select(sides[0].type, build(c, BOOL), *sides))
        inner = _operand_type(operands, found, wanted)
        return apply(values, op, tuple(build(x, inner) for x in operands))

    return values.splat(build(pattern, type_), type_)


def _operand_type(operands: tuple[ast.expr, ...], found: Found, wanted: Type) -> Type:
    """The type of numbers among operands: that of the names beside them."""
    types = [
        found[n.id].type for p in operands for n in ast.walk(p) if isinstance(n, ast.Name) and n.id in found
    ]
    wide = [t for t in types if isinstance(t, Vector)]
    return wide[0] if wide else types[0] if types else wanted


def apply(values: Values, op: str, operands: tuple[ir.Expr, ...]) -> ir.Expr:
    """The value of an operation by name, of the type that the registry gives it."""
    row = BUILTINS[op] if op in BUILTINS else OPERATORS[op]
    type_ = row.result(tuple(x.type for x in operands))
    if type_ is None:  # a scalar beside a vector
        vector = next(x.type for x in operands if isinstance(x.type, Vector))
        operands = tuple(values.splat(x, vector) for x in operands)
        type_ = row.result(tuple(x.type for x in operands))
    assert type_ is not None
    if op in BUILTINS:
        return values.build(ir.Builtin(type_, op, operands))
    if len(operands) == 1:
        return values.build(ir.Unary(type_, op, operands[0]))
    return values.build(ir.Binary(type_, op, *operands))
