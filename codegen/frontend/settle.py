"""Constant parts of expressions: whole numbers are calculated here, floats are checked.

WGSL calculates constant expressions while it compiles and refuses what overflows, has bits shifted out or is
no finite number; the other languages compute something. So integers and truth values, which are exact, become
literals, and a constant float expression without a finite value is an error in the source.
"""

from __future__ import annotations

import math
import operator
import struct
from collections.abc import Callable
from typing import Any

from codegen.frontend.constants import to_float32
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, Scalar, Vector

Parts = tuple[Any, ...]
LARGEST = float.fromhex("0x1.fffffep127")


class NoValueError(Exception):
    """A constant expression without a value; the message completes 'this constant expression ...'."""


def settle(e: ir.Expr) -> ir.Expr:
    """The expression, or the literal that it is. Raises NoValueError where WGSL would refuse it."""
    parts = value(e)
    if parts is None:
        return e
    if any(isinstance(p, float) and not abs(p) <= LARGEST for p in parts):
        raise NoValueError("is not a finite number")
    if e.type in (I32, U32, BOOL) and not isinstance(e, ir.Const):
        return ir.Const(e.type, parts[0])
    return e


def value(e: ir.Expr) -> Parts | None:
    """The components of a constant expression, floats in double precision; None for any other."""
    if isinstance(e, ir.Const):
        return (e.value,)
    known: list[Parts] = []
    for child in ir.children(e):
        part = value(child)
        if part is None:
            return None
        known.append(part)
    try:
        return _components(e, known)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise NoValueError("is not a finite number") from None


def _components(e: ir.Expr, parts: list[Parts]) -> Parts | None:
    match e:
        case ir.Construct():
            if not isinstance(e.type, Vector):
                return None
            flat = tuple(x for p in parts for x in p)
            return flat * e.type.size if len(flat) == 1 else flat
        case ir.Swizzle():
            return tuple(parts[0]["xyzw".index(c)] for c in e.components)
        case ir.Select():
            return parts[1] if parts[0][0] else parts[2]
        case ir.Convert():
            assert isinstance(e.type, Scalar)
            return (_convert(parts[0][0], e.type),)
        case ir.Builtin() if e.op in _GEOMETRY:
            return _GEOMETRY[e.op](*parts)
        case ir.Unary() | ir.Binary() | ir.Builtin():
            size = max(map(len, parts))
            columns = zip(*(p * size if len(p) == 1 else p for p in parts), strict=True)
            element = e.type.element if isinstance(e.type, Vector) else e.type
            return tuple(_wrapped(_SCALAR[e.op](*column), element) for column in columns)
        case _:
            return None


def _wrapped(x: Any, element: Any) -> Any:
    """The value in its type: u32 modulo 2^32, an i32 that fits."""
    if element == U32:
        return int(x) % 2**32
    if element == I32 and not -(2**31) < x < 2**31:
        raise NoValueError("does not fit into an i32")
    return x


def _convert(x: Any, type_: Scalar) -> Any:
    if type_ == F32:
        return float(x)
    whole = math.trunc(x)
    low, high = (0, 2**32 - 1) if type_ == U32 else (-(2**31) + 1, 2**31 - 1)
    if isinstance(x, float) and not low <= whole <= high:
        raise NoValueError(f"does not fit into {type_.name}")
    if type_ == U32:
        return whole % 2**32
    return _wrapped(whole if whole <= high else whole - 2**32, I32)


def _clamp(x: Any, low: Any, high: Any) -> Any:
    if low > high:
        raise NoValueError("clamps to an empty range")
    return min(max(x, low), high)


def _shift_left(a: int, b: int) -> int:
    return a << (b & 31)  # WGSL and C refuse more; the front end does so for literals


def _from_bits(bits: int) -> float:
    found: float = struct.unpack("<f", struct.pack("<I", bits))[0]
    return found


def _to_bits(x: float) -> int:
    rounded = to_float32(x)
    if rounded is None:
        raise NoValueError("does not fit into a normal float32")
    found: int = struct.unpack("<I", struct.pack("<f", rounded))[0]
    return found


def _dot(a: Parts, b: Parts) -> Parts:
    return (sum(x * y for x, y in zip(a, b, strict=True)),)


def _cross(a: Parts, b: Parts) -> Parts:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


_GEOMETRY: dict[str, Callable[..., Parts]] = {
    "dot": _dot,
    "cross": _cross,
    "length": lambda x: (math.hypot(*x),),
    "normalize": lambda x: tuple(c / math.hypot(*x) for c in x),
}

_SCALAR: dict[str, Callable[..., Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv,
    "//": operator.floordiv, "%": operator.mod, "negate": operator.neg, "~": operator.invert,
    "<<": _shift_left, ">>": lambda a, b: a >> (b & 31),
    "&": operator.and_, "|": operator.or_, "^": operator.xor,
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge,
    "==": operator.eq, "!=": operator.ne,
    "and": lambda a, b: a and b, "or": lambda a, b: a or b, "not": operator.not_,
    "abs": abs, "min": min, "max": max, "clamp": _clamp, "floor": lambda x: float(math.floor(x)),
    "sqrt": math.sqrt, "inverse_sqrt": lambda x: 1.0 / math.sqrt(x),
    "exp": math.exp, "exp2": math.exp2, "log": math.log, "log2": math.log2,
    "sin": math.sin, "cos": math.cos, "atan2": math.atan2,
    "float_to_bits": _to_bits, "bits_to_float": _from_bits,
}  # fmt: skip
