"""The front end takes every operator, conversion and vector of the subset for what it is.

Plan.
  operators    each one of two operands and of one, on types that take it, becomes its operation, also where
               it is written before "="
  conversions  each number type from each other one
  literals     an integer literal takes the type of what stands beside it, on either side
  vectors      of every kind, from one number, from numbers, and from shorter vectors
What is refused is the business of test_frontend_refusals.py.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, UVEC2, UVEC3, VALUE_TYPES, VEC2, VEC3, VEC4, Type, Vector
from conformance.unit.support.sources import library_of

NUMBERS, TRUTHS = "+ - * / < <= > >= == !=", "and or"
BITS = "// % << >> & | ^"
TYPES: dict[str, Type] = {"x": F32, "y": F32, "n": U32, "m": U32, "k": I32, "j": I32, "p": BOOL, "q": BOOL}
HEAD = "def probe(x: X, y: X, n: u32, m: u32, k: i32, j: i32, p: bool, q: bool, u: V, w: P) -> {}:\n"
PAIRS = {
    **{f"x {op} y": op for op in NUMBERS.split()},
    **{f"k {op} j": op for op in NUMBERS.split() if op != "/"},
    **{f"n {op} m": op for op in (*NUMBERS.split(), *BITS.split()) if op != "/"},
    **{f"p {op} q": op for op in TRUTHS.split()},
}
COMPARISONS = {"<", "<=", ">", ">=", "==", "!="}


def var(name: str) -> ir.Var:
    return ir.Var(TYPES[name], name)


def returned(folder: Path, text: str, type_: Type) -> ir.Expr:
    """What a function of HEAD that returns this expression returns."""
    library = library_of(folder, HEAD.format(type_.name) + f"    return {text}\n")
    (statement,) = library.function("probe").body
    assert isinstance(statement, ir.Return)
    return statement.value


@pytest.mark.parametrize("text", PAIRS)
def test_operators_of_two_operands(text: str, tmp_path: Path) -> None:
    op = PAIRS[text]
    left, right = var(text[0]), var(text[-1])
    result = BOOL if op in COMPARISONS else left.type
    assert returned(tmp_path, text, result) == ir.Binary(result, op, left, right)


@pytest.mark.parametrize("op", [op for op in (*NUMBERS.split(), *BITS.split()) if op not in COMPARISONS])
def test_operators_before_an_equals_sign(op: str, tmp_path: Path) -> None:
    name, other, type_ = ("x", "y", F32) if op == "/" else ("n", "m", U32)
    body = f"    a = {name}\n    a {op}= {other}\n    return a\n"
    library = library_of(tmp_path, HEAD.format(type_.name) + body)
    assert library.function("probe").body[1] == ir.Assign(
        "a", ir.Binary(type_, op, ir.Var(type_, "a"), var(other))
    )


@pytest.mark.parametrize(("text", "op"), [("-x", "negate"), ("-k", "negate"), ("~n", "~"), ("not p", "not")])
def test_operators_of_one_operand(text: str, op: str, tmp_path: Path) -> None:
    operand = var(text[-1])
    assert returned(tmp_path, text, operand.type) == ir.Unary(operand.type, op, operand)


@pytest.mark.parametrize("target", ["f32", "i32", "u32"])
@pytest.mark.parametrize("name", ["x", "k", "n"])
def test_conversions(name: str, target: str, tmp_path: Path) -> None:
    type_, operand = VALUE_TYPES[target], var(name)
    expected = operand if operand.type == type_ else ir.Convert(type_, operand)
    assert returned(tmp_path, f"{target}({name})", type_) == expected


@pytest.mark.parametrize("target", ["i32", "u32"])
def test_whole_numbers_are_converted_as_they_are_read(target: str, tmp_path: Path) -> None:
    type_ = VALUE_TYPES[target]
    assert returned(tmp_path, f"{target}(2 + 3)", type_) == ir.Const(type_, 5)


def whole(type_: Type, value: int) -> ir.Const:
    return ir.Const(type_, value)


LITERALS: dict[str, ir.Expr] = {
    **{f"n {op} 3": ir.Binary(U32, op, var("n"), whole(U32, 3)) for op in ("+", "&", "<<", "//")},
    **{f"3 {op} n": ir.Binary(U32, op, whole(U32, 3), var("n")) for op in ("+", "&", "<<", "//")},
    "k * -3": ir.Binary(I32, "*", var("k"), whole(I32, -3)),
    "-3 * k": ir.Binary(I32, "*", whole(I32, -3), var("k")),
    "3 < n": ir.Binary(BOOL, "<", whole(U32, 3), var("n")),
    "3 if p else n": ir.Select(U32, var("p"), whole(U32, 3), var("n")),
    "n if p else 3": ir.Select(U32, var("p"), var("n"), whole(U32, 3)),
    "-3 if p else k": ir.Select(I32, var("p"), whole(I32, -3), var("k")),
    "uvec2(3, n) + uvec2(n, 4)": ir.Binary(
        UVEC2,
        "+",
        ir.Construct(UVEC2, (whole(U32, 3), var("n"))),
        ir.Construct(UVEC2, (var("n"), whole(U32, 4))),
    ),
    "n << 0": ir.Binary(U32, "<<", var("n"), whole(U32, 0)),
    "n >> 31": ir.Binary(U32, ">>", var("n"), whole(U32, 31)),
    "1 if p else 2": ir.Select(U32, var("p"), whole(U32, 1), whole(U32, 2)),
    "f32(7)": ir.Convert(F32, whole(I32, 7)),
    "~7": ir.Const(U32, 2**32 - 8),
    "min(3, k)": ir.Builtin(I32, "min", (whole(I32, 3), var("k"))),
    "clamp(k, -3, 3)": ir.Builtin(I32, "clamp", (var("k"), whole(I32, -3), whole(I32, 3))),
    "clamp(3, n, m)": ir.Builtin(U32, "clamp", (whole(U32, 3), var("n"), var("m"))),
}


@pytest.mark.parametrize("text", LITERALS)
def test_integer_literals_take_the_type_beside_them(text: str, tmp_path: Path) -> None:
    expected = LITERALS[text]
    assert returned(tmp_path, text, expected.type) == expected


P, V = ir.Var(VEC2, "w"), ir.Var(VEC3, "u")
VECTORS: dict[str, tuple[Vector, tuple[ir.Expr, ...]]] = {
    "vec2(x)": (VEC2, (var("x"),)),
    "vec3(x)": (VEC3, (var("x"),)),
    "vec4(x)": (VEC4, (var("x"),)),
    "uvec2(n)": (UVEC2, (var("n"),)),
    "uvec3(n)": (UVEC3, (var("n"),)),
    "vec2(x, y)": (VEC2, (var("x"), var("y"))),
    "vec3(x, y, x)": (VEC3, (var("x"), var("y"), var("x"))),
    "vec3(x, w)": (VEC3, (var("x"), P)),
    "vec4(w, w)": (VEC4, (P, P)),
    "vec4(u, x)": (VEC4, (V, var("x"))),
    "vec4(x, w, y)": (VEC4, (var("x"), P, var("y"))),
    "vec3(u)": (VEC3, (V,)),
    "uvec3(n, 7, m)": (UVEC3, (var("n"), whole(U32, 7), var("m"))),
}


@pytest.mark.parametrize("text", VECTORS)
def test_vectors_are_made_of_their_parts(text: str, tmp_path: Path) -> None:
    type_, parts = VECTORS[text]
    assert returned(tmp_path, text, type_) == ir.Construct(type_, parts)
