"""Constant expressions: numbers and arithmetic on them, folded in double precision."""

from __future__ import annotations

import ast
import math
import operator
import struct
from collections.abc import Callable

Number = float | int | bool

_LARGEST_INTEGER_EXPONENT = 64
"""Shifts and powers of whole numbers beyond this leave 32 bits anyway; the limit keeps them quick."""

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
            return value  # True and False stand for themselves: there is no arithmetic on them
        case ast.Name(id=name):
            return lookup(name)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            negated = fold(operand, lookup)
            return None if negated is None or isinstance(negated, bool) else -negated
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            a, b = fold(left, lookup), fold(right, lookup)
            if a is None or b is None or isinstance(a, bool) or isinstance(b, bool):
                return None
            return _calculate(op, a, b)
        case _:
            return None


def _calculate(op: ast.operator, a: float | int, b: float | int) -> float | int | None:
    """The value of one operation; None where it has none, or where whole numbers would become a fraction."""
    whole = isinstance(a, int) and isinstance(b, int)
    if isinstance(op, ast.FloorDiv | ast.LShift) and not whole:
        return None
    if whole and isinstance(op, ast.Div):
        return None
    if whole and isinstance(op, ast.Pow | ast.LShift) and not 0 <= b <= _LARGEST_INTEGER_EXPONENT:
        return None
    try:
        value = _BINARY[type(op)](a, b)
    except (ZeroDivisionError, OverflowError):
        return None
    return None if isinstance(value, complex) else value


SMALLEST_NORMAL = 2.0**-126


def to_float32(value: float) -> float | None:
    """The nearest float32, as a Python float; None where it overflows or where targets may flush it to 0."""
    try:
        rounded = float(struct.unpack("<f", struct.pack("<f", value))[0])
    except OverflowError:
        return None
    if not math.isfinite(rounded) or (value != 0.0 and abs(rounded) < SMALLEST_NORMAL):
        return None
    return rounded
