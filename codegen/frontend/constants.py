"""Constant expressions: numbers and arithmetic on them, folded in double precision."""

from __future__ import annotations

import ast
import operator
import struct
from collections.abc import Callable

Number = float | int | bool

_BINARY: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.LShift: operator.lshift,
    ast.FloorDiv: operator.floordiv,
}


def fold(node: ast.expr, lookup: Callable[[str], Number | None]) -> Number | None:
    """The value of a constant expression; None if it is not one. `lookup` gives named constants."""
    match node:
        case ast.Constant(value=bool() | int() | float() as value):
            return value
        case ast.Name(id=name):
            return lookup(name)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            negated = fold(operand, lookup)
            return None if negated is None else -negated
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            a, b = fold(left, lookup), fold(right, lookup)
            if a is None or b is None:
                return None
            try:
                return _BINARY[type(op)](a, b)
            except (ZeroDivisionError, OverflowError, TypeError):
                return None
        case _:
            return None


def to_float32(value: float) -> float | None:
    """The nearest float32, as a Python float; None where it overflows."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", value))[0])
    except OverflowError:
        return None
