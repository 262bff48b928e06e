"""Literals: the shortest decimal that reads back as the same float32 (or half), always visibly a float."""

from __future__ import annotations

import struct

from codegen.emit.dialect import Dialect
from codegen.ir.nodes import Const
from codegen.ir.types import BOOL, F16, F32, U32


def shortest(value: float, kind: str = "f") -> str:
    """The shortest decimal text that rounds to this float32 ("f") or this half ("e")."""
    for digits in range(1, 10):
        text = f"{value:.{digits}g}"
        if _reads_as(text, value, kind):
            break
    number = float(text)
    plain = repr(number)
    if "e" in plain or not (number == 0.0 or 1e-4 <= abs(number) < 1e7):
        mantissa, exponent = f"{number:.{digits - 1}e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return plain


def _reads_as(text: str, value: float, kind: str) -> bool:
    try:
        return struct.pack(f"<{kind}", float(text)) == struct.pack(f"<{kind}", value)
    except OverflowError:  # few digits of a large number may round up beyond the largest one
        return False


def literal(const: Const, dialect: Dialect) -> str:
    """The literal in a dialect."""
    if const.type == BOOL:
        return "true" if const.value else "false"
    if const.type == F32:
        return shortest(float(const.value)) + dialect.float_suffix
    if const.type == F16:
        return shortest(float(const.value), "e") + dialect.half_suffix
    return f"{const.value}u" if const.type == U32 else str(const.value)
