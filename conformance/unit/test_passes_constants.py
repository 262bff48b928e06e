"""Operations on constants, one at a time: what each becomes, worked out by hand, and what is left alone.

Plan.
  values   scalars, vectors, a scalar beside a vector; integers wrap; a zero has no sign
  ends     the largest and the smallest normal number are constants, what lies beyond them is none
  log      floats are rounded once, integers and truth values are exact; a decided choice says which way
"""

from __future__ import annotations

import math

import pytest

from codegen.intervals.numbers import LARGEST, SMALLEST
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, VEC2, VEC3, Field, Struct, Type, Vector, array_of
from codegen.passes.rules.fold import constants
from codegen.passes.ssa.text import show
from codegen.passes.ssa.values import Values, constant_components

Number = float | int | bool
X = ir.Var(F32, "x")


def number(value: Number, type_: Type = F32) -> ir.Expr:
    return ir.Const(type_, value)


def vector(*parts: float) -> ir.Expr:
    type_ = {1: VEC3, 2: VEC2, 3: VEC3}[len(parts)]
    return ir.Construct(type_, tuple(ir.Const(F32, x) for x in parts))


def binary(type_: Type, op: str, a: ir.Expr, b: ir.Expr) -> ir.Expr:
    return ir.Binary(type_, op, a, b)


def whole(op: str, a: int, b: int) -> ir.Expr:
    return binary(U32, op, number(a, U32), number(b, U32))


def ids(given: ir.Expr | tuple[Number, ...]) -> str:
    return str(given) if isinstance(given, tuple) else show(given)


FOLDED: list[tuple[ir.Expr, tuple[Number, ...]]] = [
    (binary(F32, "-", number(1.0), number(0.25)), (0.75,)),
    (binary(F32, "/", number(1.0), number(3.0)), (0.3333333432674408,)),
    (binary(F32, "/", number(1.0), number(-4.0)), (-0.25,)),
    (binary(VEC3, "+", vector(1.0, 2.0, 3.0), vector(0.5, -2.0, 4.0)), (1.5, 0.0, 7.0)),
    (binary(VEC3, "*", vector(1.0, 2.0, 3.0), number(2.0)), (2.0, 4.0, 6.0)),
    (binary(VEC3, "*", number(-1.0), vector(1.0, 0.0, 3.0)), (-1.0, 0.0, -3.0)),
    (binary(VEC3, "/", vector(1.0, 2.0, 3.0), number(-4.0)), (-0.25, -0.5, -0.75)),
    (binary(VEC3, "-", vector(5.0), vector(1.0, 2.0, 3.0)), (4.0, 3.0, 2.0)),
    (ir.Builtin(F32, "dot", (vector(1.0, 2.0, 3.0), vector(4.0, -5.0, 6.0))), (12.0,)),
    (ir.Builtin(F32, "length", (vector(3.0, 4.0),)), (5.0,)),
    (ir.Builtin(VEC3, "cross", (vector(1.0, 0.0, 0.0), vector(0.0, 1.0, 0.0))), (0.0, 0.0, 1.0)),
    (ir.Builtin(VEC2, "normalize", (vector(3.0, -4.0),)), (0.6000000238418579, -0.800000011920929)),
    (ir.Builtin(VEC2, "max", (vector(3.0, -4.0), vector(1.0, 2.0))), (3.0, 2.0)),
    (ir.Builtin(F32, "clamp", (number(3.0), number(0.0), number(1.0))), (1.0,)),
    (ir.Builtin(F32, "atan2", (number(0.0), number(1.0))), (0.0,)),
    (ir.Unary(VEC2, "negate", vector(0.0, 2.0)), (0.0, -2.0)),
    (ir.Unary(F32, "negate", number(0.0)), (0.0,)),
    (whole("//", 5, 2), (2,)),
    (whole("%", 5, 3), (2,)),
    (whole("//", 0, 2), (0,)),
    (whole("-", 2, 5), (4_294_967_293,)),
    (whole("*", 65_537, 65_537), (131_073,)),
    (whole("+", 3, 0), (3,)),
    (binary(I32, "*", number(-7, I32), number(3, I32)), (-21,)),
    (ir.Unary(U32, "~", number(0, U32)), (4_294_967_295,)),
    (ir.Unary(BOOL, "not", number(False, BOOL)), (True,)),
    (binary(BOOL, "<", number(1.0), number(2.0)), (True,)),
    (binary(BOOL, "==", number(1, U32), number(2, U32)), (False,)),
    (binary(BOOL, "and", number(True, BOOL), number(False, BOOL)), (False,)),
    (ir.Convert(F32, number(7, U32)), (7.0,)),
    (ir.Convert(F32, number(4_000_000_000, U32)), (4_000_000_000.0,)),
    (ir.Convert(F32, number(0.5)), (0.5,)),
    (ir.Convert(F32, number(-7, I32)), (-7.0,)),
    (ir.Convert(F32, number(16_777_217, I32)), (16_777_216.0,)),
    (ir.Convert(I32, number(4_294_967_289, U32)), (-7,)),
    (ir.Convert(U32, number(-7, I32)), (4_294_967_289,)),
    (ir.Convert(U32, number(-0.75)), (0,)),
    (ir.Convert(I32, number(-63.5)), (-63,)),
    (ir.Convert(I32, number(63.5)), (63,)),
    (ir.Convert(I32, number(2_147_483_520.0)), (2_147_483_520,)),
    (ir.Convert(U32, number(4_294_967_040.0)), (4_294_967_040,)),
    (ir.Convert(I32, number(-2_147_483_648.0)), (-2_147_483_648,)),
    (binary(F32, "*", number(LARGEST), number(-1.0)), (-LARGEST,)),
    (binary(F32, "*", number(SMALLEST), number(-1.0)), (-SMALLEST,)),
    (binary(F32, "*", number(SMALLEST), number(0.0)), (0.0,)),
    (binary(F32, "*", number(2.0 * SMALLEST), number(0.5)), (SMALLEST,)),
    (binary(F32, "+", number(LARGEST), number(1e30)), (LARGEST,)),
]


@pytest.mark.parametrize(("e", "expected"), FOLDED, ids=ids)
def test_value_of_an_operation_on_constants(e: ir.Expr, expected: tuple[Number, ...]) -> None:
    values = Values(rules=(constants,))
    found = values.build(e)
    parts = constant_components(found)
    assert found.type == e.type
    assert parts == expected
    assert isinstance(found, ir.Construct) == isinstance(e.type, Vector)
    for part, wanted in zip(parts, expected, strict=True):
        assert type(part) is type(wanted)
        assert math.copysign(1.0, part) == math.copysign(1.0, wanted)
    (step,) = values.log
    assert step.name == "fold"
    element = e.type.element if isinstance(e.type, Vector) else e.type
    assert step.why.startswith(
        "constants, rounded once: the float32" if element == F32 else "constants of integers or truth values"
    )


PAIR = Struct("Pair", (Field("first", F32), Field("second", F32)))
KEPT: list[ir.Expr] = [
    binary(F32, "+", X, number(1.0)),
    binary(F32, "*", number(1.0), X),
    binary(F32, "*", number(LARGEST), number(2.0)),
    binary(F32, "*", number(LARGEST), number(-2.0)),
    binary(F32, "*", number(SMALLEST), number(0.5)),
    binary(F32, "*", number(SMALLEST), number(-0.5)),
    binary(F32, "/", number(1.0), number(0.0)),
    binary(F32, "/", number(0.0), number(0.0)),
    binary(VEC3, "/", vector(0.0, 1.0, 2.0), number(0.0)),
    binary(VEC3, "*", vector(1.0, LARGEST, 2.0), number(3.0)),
    binary(VEC2, "*", vector(1.0, 1e-30), number(1e-10)),
    ir.Builtin(F32, "sqrt", (number(-1.0),)),
    ir.Builtin(VEC2, "sqrt", (vector(4.0, -1.0),)),
    ir.Builtin(F32, "exp", (number(100.0),)),
    ir.Builtin(VEC2, "normalize", (vector(0.0, 0.0),)),
    whole("//", 5, 0),
    whole("%", 5, 0),
    ir.Convert(U32, number(-1.0)),
    ir.Convert(U32, number(4_294_967_296.0)),
    ir.Convert(I32, number(2_147_483_648.0)),
    ir.Convert(I32, number(-2_147_483_904.0)),
    ir.Convert(F32, ir.Var(U32, "n")),
    ir.Select(F32, ir.Var(BOOL, "p"), number(1.0), number(2.0)),
    vector(1.0, 2.0),
    ir.Construct(PAIR, (number(1.0), number(2.0))),
    ir.Index(F32, ir.Construct(array_of(F32, 2), (number(1.0), number(2.0))), number(1, I32)),
    ir.Swizzle(F32, vector(1.0, 2.0), "x"),
    ir.Call(F32, "f", (number(1.0),)),
    number(1.0),
    X,
]


@pytest.mark.parametrize("e", KEPT, ids=ids)
def test_what_has_no_value_everywhere_is_left_alone(e: ir.Expr) -> None:
    values = Values(rules=(constants,))
    assert values.rebuild(e) == e
    assert not values.log


@pytest.mark.parametrize(("condition", "left"), [(True, "x"), (False, "1")])
def test_a_decided_choice_is_its_side(condition: bool, left: str) -> None:
    values = Values(rules=(constants,))
    found = values.rebuild(ir.Select(F32, number(condition, BOOL), X, number(1.0)))
    assert values.show(found) == left
    (step,) = values.log
    assert (step.name, step.why) == ("fold", f"the condition is {str(condition).lower()}")
    assert step.what == f"x if {str(condition).lower()} else 1 -> {left}"
