"""Constant folding: an operation on constants is its value, correctly rounded.

before   1.0 - 0.25      exp(0.0)     5 // 2
after    0.75            1.0          2

Floats are computed in float64 and rounded once: every table permits the float32 nearest to the exact result.
Not folded: what would overflow, be no number, or lie below the normal numbers, where targets differ.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from codegen.evaluate.arrays import INTEGER_TYPES, arithmetic
from codegen.intervals.numbers import LARGEST, SMALLEST
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, Scalar, Type, Vector
from codegen.ops import BUILTINS, OPERATORS
from codegen.passes.ssa.values import Rewrite, Values, constant_components

NAME = "fold"
FLOAT = "constants, rounded once: the float32 nearest to the exact result, which every target permits"
WHOLE = "constants of integers or truth values: exact"


def constants(values: Values, e: ir.Expr) -> Rewrite | None:
    """Folds an operation all of whose operands are constants."""
    if not isinstance(e, ir.Unary | ir.Binary | ir.Builtin | ir.Convert | ir.Select):
        return None
    if isinstance(e, ir.Select):
        return _decided(e) or _settled(values, e)
    columns: list[Any] = []
    for c in ir.children(e):
        operand = constant_components(c)
        if operand is None:
            return None
        columns.append(_column(c.type, operand))
    with np.errstate(all="ignore"):
        found = _computed(e, columns)
    if found is None:
        return None
    element = e.type.element if isinstance(e.type, Vector) else e.type
    assert isinstance(element, Scalar)
    parts: list[ir.Expr] = []
    for x in np.atleast_1d(found).tolist():
        number = _number(element, x)
        if number is None:
            return None
        parts.append(values.build(ir.Const(element, number)))
    whole = values.build(ir.Construct(e.type, tuple(parts))) if isinstance(e.type, Vector) else parts[0]
    return Rewrite(whole, NAME, FLOAT if element == F32 else WHOLE)


def _decided(e: ir.Select) -> Rewrite | None:
    if isinstance(e.condition, ir.Const):
        chosen = e.if_true if e.condition.value else e.if_false
        return Rewrite(chosen, NAME, f"the condition is {str(e.condition.value).lower()}")
    return None


def _settled(values: Values, e: ir.Select) -> Rewrite | None:
    """Each side knows the condition: c ? !c : c is false."""
    if e.type != BOOL:
        return None
    sides: list[ir.Expr] = []
    for side, holds in ((e.if_true, True), (e.if_false, False)):
        denied = isinstance(side, ir.Unary) and side.operand is e.condition
        known = denied or side is e.condition
        sides.append(values.build(ir.Const(BOOL, holds != denied)) if known else side)
    a, b = sides
    if a is e.if_true and b is e.if_false:
        return None
    chosen = a if a is b else values.build(replace(e, if_true=a, if_false=b))
    return Rewrite(chosen, NAME, "each side knows the condition")


def _column(type_: Type, numbers: tuple[float | int | bool, ...]) -> Any:
    """A value as one lane: of shape (1,), or (n,) for a vector; a scalar beside a vector widens by itself."""
    element = type_.element if isinstance(type_, Vector) else type_
    assert isinstance(element, Scalar)
    return np.array(numbers, np.float64 if element == F32 else INTEGER_TYPES[element])


def _computed(e: ir.Expr, columns: list[Any]) -> Any:
    m = arithmetic("float64").namespace
    match e:
        case ir.Convert():
            return _converted(e.type, columns[0])
        case ir.Builtin():
            return BUILTINS[e.op].meaning(m, *columns)
        case ir.Unary():
            return OPERATORS[e.op].meaning(m, columns[0])
        case ir.Binary():
            a, b = columns
            if e.op in ("//", "%") and b[0] == 0:
                return None
            return OPERATORS[e.op].meaning(m, a, b)
        case _:
            return None


def _converted(type_: Type, a: Any) -> Any:
    if type_ == F32:
        return a.astype(np.float64)
    if a.dtype.kind == "f":
        least, beyond = (-(2**31), 2**31) if type_ == I32 else (0, 2**32)
        whole = np.trunc(a)
        return whole.astype(np.int64) if least <= whole[0] < beyond else None
    return a.astype(np.int64).astype(np.uint32 if type_ == U32 else np.int32)


def _number(element: Scalar, x: Any) -> float | int | bool | None:
    if element == BOOL:
        return bool(x)
    if element != F32:
        return int(x)
    with np.errstate(over="ignore"):
        value = float(np.float32(x))
    if not abs(value) <= LARGEST or 0.0 < abs(value) < SMALLEST:
        return None
    return value + 0.0  # -0 becomes 0: nothing relies on the sign of a zero
