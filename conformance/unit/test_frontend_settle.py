"""Constant parts of expressions have the value that WGSL calculates, or none, and that is said.

Plan.
  values   every operation on numbers of its types, between zero and the ends, with operands that tell apart
           their order, against values written by hand; vectors part by part, a number beside a vector
  none     what holds a variable, a field, a call or an element anywhere is left as it stands
  refused  what has no value: each sentence, at the last value that fits and at the first that does not
  settled  whole numbers and truth values become literals, floats stay expressions
"""

import math

import pytest

from codegen.frontend.settle import LARGEST, NoValueError, settle, value
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, UVEC2, VEC2, VEC3, VEC4, Field, Struct, Type, array_of
from codegen.ops import BUILTINS
from conformance.unit.support.tolerances import tolerance

Given = float | int | tuple[float, ...]
ONE_IN_32 = 2**32
VECTORS = {2: VEC2, 3: VEC3, 4: VEC4}
X = ir.Var(F32, "x")


def const(x: float | bool, type_: Type = F32) -> ir.Expr:
    return ir.Const(type_, x)


def constant(x: Given, type_: Type = F32) -> ir.Expr:
    """A literal, or a vector of literals."""
    if isinstance(x, tuple):
        return ir.Construct(VECTORS[len(x)], tuple(const(c) for c in x))
    return const(x, type_)


def builtin(op: str, *args: Given, type_: Type = F32, returns: Type | None = None) -> ir.Expr:
    given = tuple(constant(x, type_) for x in args)
    return ir.Builtin(returns or given[0].type, op, given)


def binary(op: str, a: Given, b: Given, type_: Type = F32, returns: Type | None = None) -> ir.Expr:
    left, right = constant(a, type_), constant(b, type_)
    widest = right.type if isinstance(b, tuple) else left.type
    return ir.Binary(returns or widest, op, left, right)


def whole(op: str, a: int, b: int, type_: Type = U32) -> ir.Expr:
    return binary(op, a, b, type_)


def truth(op: str, a: float, b: float, type_: Type = F32) -> ir.Expr:
    return binary(op, a, b, type_, BOOL)


def convert(type_: Type, x: float | bool, from_: Type) -> ir.Expr:
    return ir.Convert(type_, const(x, from_))


def choice(which: bool) -> ir.Expr:
    return ir.Select(F32, const(which, BOOL), const(1.5), const(2.5))


def swizzle(components: str, *of: float) -> ir.Expr:
    type_ = F32 if len(components) == 1 else VECTORS[len(components)]
    return ir.Swizzle(type_, constant(of), components)


VALUES: dict[str, tuple[ir.Expr, tuple[float, ...]]] = {
    "literal": (const(1.5), (1.5,)),
    "sum": (binary("+", 1.5, 0.25), (1.75,)),
    "difference": (binary("-", 1.5, 0.25), (1.25,)),
    "product": (binary("*", 1.5, 0.25), (0.375,)),
    "quotient": (binary("/", 1.5, 0.25), (6.0,)),
    "in double precision": (binary("+", 1.0, 2.0**-40), (1.0 + 2.0**-40,)),
    "negated": (ir.Unary(F32, "negate", const(1.5)), (-1.5,)),
    "whole sum": (whole("+", 3, 4), (7,)),
    "whole quotient": (whole("//", 7, 2), (3,)),
    "whole rest": (whole("%", 7, 4), (3,)),
    "u32 beyond its end": (whole("+", ONE_IN_32 - 1, 2), (1,)),
    "u32 below 0": (whole("-", 1, 3), (ONE_IN_32 - 2,)),
    "u32 product": (whole("*", 65537, 65537), (131073,)),
    "i32 at its end": (whole("+", 2**31 - 2, 1, I32), (2**31 - 1,)),
    "i32 at its lower end": (whole("-", -(2**31) + 2, 1, I32), (-(2**31) + 1,)),
    "left shift": (whole("<<", 5, 3), (40,)),
    "left shift out of u32": (whole("<<", 3, 31), (2**31,)),
    "left shift by its width": (whole("<<", 3, 33), (6,)),
    "right shift": (whole(">>", 40, 3), (5,)),
    "right shift by its width": (whole(">>", 40, 33), (20,)),
    "and of bits": (whole("&", 12, 10), (8,)),
    "or of bits": (whole("|", 12, 10), (14,)),
    "exclusive or": (whole("^", 12, 10), (6,)),
    "all bits but some": (ir.Unary(U32, "~", const(1, U32)), (ONE_IN_32 - 2,)),
    "all bits of an i32": (ir.Unary(I32, "~", const(5, I32)), (-6,)),
    "both": (binary("and", True, False, BOOL), (False,)),
    "either": (binary("or", False, True, BOOL), (True,)),
    "both hold": (binary("and", True, True, BOOL), (True,)),
    "none holds": (binary("or", False, False, BOOL), (False,)),
    "not": (ir.Unary(BOOL, "not", const(False, BOOL)), (True,)),
    **{
        f"{a} {op} {b}": (truth(op, a, b), (holds,))
        for op, ordered in {
            "<": (True, False, False),
            "<=": (True, True, False),
            ">": (False, False, True),
            ">=": (False, True, True),
            "==": (False, True, False),
            "!=": (True, False, True),
        }.items()
        for (a, b), holds in zip([(1.0, 2.0), (2.0, 2.0), (3.0, 2.0)], ordered, strict=True)
    },
    "abs": (builtin("abs", -1.5), (1.5,)),
    "min": (builtin("min", 2.5, 1.5), (1.5,)),
    "max": (builtin("max", 2.5, 1.5), (2.5,)),
    "clamp below": (builtin("clamp", 0.5, 1.0, 2.0), (1.0,)),
    "clamp inside": (builtin("clamp", 1.5, 1.0, 2.0), (1.5,)),
    "clamp above": (builtin("clamp", 2.5, 1.0, 2.0), (2.0,)),
    "clamp to one number": (builtin("clamp", 2.5, 1.0, 1.0), (1.0,)),
    "floor": (builtin("floor", -1.5), (-2.0,)),
    "sqrt": (builtin("sqrt", 2.25), (1.5,)),
    "inverse_sqrt": (builtin("inverse_sqrt", 0.25), (2.0,)),
    "exp": (builtin("exp", 1.0), (math.e,)),
    "exp2": (builtin("exp2", -3.0), (0.125,)),
    "log": (builtin("log", 4.0), (math.log(4.0),)),
    "log2": (builtin("log2", 8.0), (3.0,)),
    "sin": (builtin("sin", 0.5), (math.sin(0.5),)),
    "cos": (builtin("cos", 0.5), (math.cos(0.5),)),
    "atan2": (builtin("atan2", 1.0, 2.0), (math.atan(0.5),)),
    "bits of a float": (builtin("float_to_bits", 1.0, returns=U32), (0x3F800000,)),
    "float of bits": (builtin("bits_to_float", 0x40200000, type_=U32, returns=F32), (2.5,)),
    "dot": (builtin("dot", (1.0, 2.0, 3.0), (4.0, 5.0, 8.0), returns=F32), (38.0,)),
    "cross": (builtin("cross", (1.0, 2.0, 4.0), (8.0, 3.0, 5.0)), (-2.0, 27.0, -13.0)),
    "length": (builtin("length", (2.0, 3.0, 6.0), returns=F32), (7.0,)),
    "normalize": (builtin("normalize", (3.0, 4.0)), (0.6, 0.8)),
    "vector": (constant((1.0, 2.0, 4.0)), (1.0, 2.0, 4.0)),
    "one number for all": (ir.Construct(VEC3, (const(1.5),)), (1.5, 1.5, 1.5)),
    "a vector and a number": (ir.Construct(VEC3, (constant((1.0, 2.0)), const(4.0))), (1.0, 2.0, 4.0)),
    "a vector of the vector": (ir.Construct(VEC2, (constant((1.0, 2.0)),)), (1.0, 2.0)),
    "part by part": (binary("-", (5.0, 7.0), (1.0, 2.0)), (4.0, 5.0)),
    "a number after a vector": (binary("-", (5.0, 7.0), 1.0), (4.0, 6.0)),
    "a number before a vector": (binary("-", 1.0, (5.0, 7.0)), (-4.0, -6.0)),
    "whole vectors": (
        ir.Binary(UVEC2, "-", ir.Construct(UVEC2, (const(1, U32), const(9, U32))), const(2, U32)),
        (ONE_IN_32 - 1, 7),
    ),
    "min of vectors": (builtin("min", (1.0, 4.0), (2.0, 3.0)), (1.0, 3.0)),
    "component": (swizzle("w", 1.0, 2.0, 4.0, 8.0), (8.0,)),
    "first component": (swizzle("x", 1.0, 2.0), (1.0,)),
    "components": (swizzle("zxy", 1.0, 2.0, 4.0), (4.0, 1.0, 2.0)),
    "first choice": (choice(True), (1.5,)),
    "second choice": (choice(False), (2.5,)),
    "u32 to f32": (convert(F32, 3, U32), (3.0,)),
    "f32 to u32": (convert(U32, 3.75, F32), (3,)),
    "f32 to u32 above -1": (convert(U32, -0.75, F32), (0,)),
    "f32 to the largest u32": (convert(U32, 4294967040.0, F32), (4294967040,)),
    "f32 to the end of u32": (convert(U32, 4294967295.5, F32), (ONE_IN_32 - 1,)),
    "f32 to i32": (convert(I32, -3.75, F32), (-3,)),
    "f32 to the largest i32": (convert(I32, 2147483647.5, F32), (2**31 - 1,)),
    "f32 to the least i32": (convert(I32, -2147483647.5, F32), (-(2**31) + 1,)),
    "i32 to u32": (convert(U32, -1, I32), (ONE_IN_32 - 1,)),
    "u32 to i32": (convert(I32, 7, U32), (7,)),
    "u32 to the largest i32": (convert(I32, 2**31 - 1, U32), (2**31 - 1,)),
    "u32 to i32 below 0": (convert(I32, ONE_IN_32 - 2, U32), (-2,)),
    "u32 to the least i32": (convert(I32, 2**31 + 1, U32), (-(2**31) + 1,)),
}

PAIR = Struct("Pair", (Field("first", F32),))
PAIRS = ir.Construct(array_of(F32, 2), (const(1.0), const(2.0)))

UNKNOWN: dict[str, ir.Expr] = {
    "variable": X,
    "sum with a variable": ir.Binary(F32, "+", const(1.0), X),
    "vector with a variable": ir.Construct(VEC2, (const(1.0), X)),
    "call": ir.Call(F32, "half", (const(1.0),)),
    "field": ir.Member(F32, ir.Var(PAIR, "pair"), "first"),
    "struct": ir.Construct(PAIR, (const(1.0),)),
    "array": PAIRS,
    "element": ir.Index(F32, PAIRS, const(1, I32)),
    "choice by a variable": ir.Select(F32, ir.Binary(BOOL, "<", X, const(0.0)), const(1.0), const(2.0)),
}

INFINITE, BEYOND_I32 = "is not a finite number", "does not fit into an i32"
NEXT = 2.0**128
"""What follows LARGEST, and has no place in float32."""

REFUSED: dict[str, tuple[ir.Expr, str]] = {
    "quotient by 0": (binary("/", 1.0, 0.0), INFINITE),
    "whole quotient by 0": (whole("//", 1, 0), INFINITE),
    "rest of 0": (whole("%", 1, 0), INFINITE),
    "too large": (binary("*", LARGEST, 2.0), INFINITE),
    "too far below 0": (binary("*", LARGEST, -2.0), INFINITE),
    "one step too large": (const(NEXT), INFINITE),
    "second part too large": (binary("*", (1.0, LARGEST), 2.0), INFINITE),
    "exp beyond double precision": (builtin("exp", 1000.0), INFINITE),
    "exp beyond single precision": (builtin("exp", 89.0), INFINITE),
    "root below 0": (builtin("sqrt", -1.0), INFINITE),
    "inverse root of 0": (builtin("inverse_sqrt", 0.0), INFINITE),
    "log of 0": (builtin("log", 0.0), INFINITE),
    "direction of nothing": (builtin("normalize", (0.0, 0.0)), INFINITE),
    "bits of no number": (builtin("bits_to_float", 0x7FC00000, type_=U32, returns=F32), INFINITE),
    "bits of infinity": (builtin("bits_to_float", 0xFF800000, type_=U32, returns=F32), INFINITE),
    "bits of a denormal": (
        builtin("float_to_bits", 1e-40, returns=U32),
        "does not fit into a normal float32",
    ),
    "empty range": (builtin("clamp", 1.0, 2.0, 1.5), "clamps to an empty range"),
    "i32 beyond its end": (whole("+", 2**31 - 1, 1, I32), BEYOND_I32),
    "i32 below its end": (whole("-", -(2**31) + 1, 1, I32), BEYOND_I32),
    "i32 shifted out": (whole("<<", 1, 31, I32), BEYOND_I32),
    "u32 to what i32 cannot write": (convert(I32, 2**31, U32), BEYOND_I32),
    "f32 beyond i32": (convert(I32, 2147483648.0, F32), "does not fit into i32"),
    "f32 below i32": (convert(I32, -2147483648.0, F32), "does not fit into i32"),
    "f32 beyond u32": (convert(U32, 4294967296.0, F32), "does not fit into u32"),
    "f32 below u32": (convert(U32, -1.0, F32), "does not fit into u32"),
}


@pytest.mark.parametrize("case", VALUES)
def test_a_constant_has_its_value(case: str) -> None:
    e, parts = VALUES[case]
    found = value(e)
    assert found is not None
    assert found == pytest.approx(parts, rel=tolerance("rounded"), abs=0.0)
    assert [type(x) for x in found] == [type(x) for x in parts]
    settle(e)


@pytest.mark.parametrize("case", UNKNOWN)
def test_what_is_no_constant_is_left_as_it_stands(case: str) -> None:
    assert value(UNKNOWN[case]) is None
    assert settle(UNKNOWN[case]) is UNKNOWN[case]


@pytest.mark.parametrize("case", REFUSED)
def test_what_has_no_value_is_refused(case: str) -> None:
    e, sentence = REFUSED[case]
    with pytest.raises(NoValueError) as caught:
        settle(e)
    assert str(caught.value) == sentence


@pytest.mark.parametrize("x", [LARGEST, -LARGEST, 0.0, 1e-45])
def test_floats_up_to_the_largest_are_left_as_they_stand(x: float) -> None:
    for e in (const(x), ir.Unary(F32, "negate", const(x)), constant((1.0, x))):
        assert settle(e) is e


@pytest.mark.parametrize("type_", [I32, U32, BOOL], ids=lambda t: t.name)
def test_whole_numbers_and_truth_values_become_literals(type_: Type) -> None:
    e = ir.Select(type_, const(True, BOOL), const(1, type_), const(0, type_))
    assert settle(e) == ir.Const(type_, 1)
    literal = const(1, type_)
    assert settle(literal) is literal


def test_vectors_of_whole_numbers_stay_vectors() -> None:
    e = ir.Construct(UVEC2, (const(1, U32), const(2, U32)))
    assert settle(e) is e


def test_every_operation_on_numbers_has_a_value() -> None:
    tried = {e.op for e, _ in VALUES.values() if isinstance(e, ir.Builtin)}
    assert tried == {op for op in BUILTINS if not op.startswith(("lookup", "texture"))}
