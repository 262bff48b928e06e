"""Patterns over values: what a text says, which values fit it, and what is made of the parts.

Plan.
  text      every kind of pattern as its tree, by hand; what is none is refused
  fits      hand-chosen values and all ways in which they fit; operands in either order only where that is the
            same; as many operands as the pattern has; the quick look never rules out what fits, and rules out
            what plainly does not
  made      numbers take the type of what stands beside them, scalars widen only where they have to
"""

from __future__ import annotations

import pytest

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, VEC2, VEC3, Type
from codegen.passes.ssa import patterns
from codegen.passes.ssa.patterns import Name, Number, Operation, Pattern
from codegen.passes.ssa.values import Values

X, Y, V, W = ir.Var(F32, "x"), ir.Var(F32, "y"), ir.Var(VEC3, "v"), ir.Var(VEC3, "w")
N, K, P, Q = ir.Var(U32, "n"), ir.Var(I32, "k"), ir.Var(BOOL, "p"), ir.Var(BOOL, "q")
TWO = ir.Const(F32, 2.0)
x, y = Name("x"), Name("y")

PARSED: dict[str, Pattern] = {
    "x": x,
    "optics.rho": Name("optics.rho"),
    "1.5": Number(1.5),
    "-2": Number(-2),
    "-0.5": Number(-0.5),
    "True": Number(True),
    "-x": Operation("negate", (x,)),
    "not x": Operation("not", (x,)),
    "x - y": Operation("-", (x, y)),
    "x < 1": Operation("<", (x, Number(1))),
    "x and y": Operation("and", (x, y)),
    "x if y else -1": Operation("select", (y, x, Number(-1))),
    "clamp(x, 0.0, y)": Operation("clamp", (x, Number(0.0), y)),
}


@pytest.mark.parametrize("text", PARSED)
def test_text_is_its_tree(text: str) -> None:
    assert patterns.parse(text) == PARSED[text]


@pytest.mark.parametrize("text", ["[x]", "x < y < 1", "f(x, k=1)", "x.y(1)", "'x'", "x and y and 1"])
def test_what_is_no_pattern_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="no pattern: "):
        patterns.parse(text)


def test_names_of_a_pattern() -> None:
    assert patterns.names(patterns.parse("max(x, -y) * (2.0 - x if not o.c else x)")) == {"x", "y", "o.c"}
    assert patterns.names(Number(1)) == set()


def both(op: str, a: ir.Expr, b: ir.Expr, type_: Type = F32) -> ir.Expr:
    return ir.Binary(type_, op, a, b)


def call(name: str, *args: ir.Expr) -> ir.Expr:
    return ir.Builtin(args[0].type, name, args)


FITS: list[tuple[str, ir.Expr, list[dict[str, ir.Expr]]]] = [
    ("x", TWO, [{"x": TWO}]),
    ("2", TWO, [{}]),
    ("1", TWO, []),
    ("1", ir.Const(BOOL, True), []),
    ("True", ir.Const(BOOL, True), [{}]),
    ("2", ir.Construct(VEC3, (TWO,)), [{}]),
    ("2", ir.Construct(VEC2, (TWO, X)), []),
    ("a + b", both("-", X, Y), []),
    ("a - b", both("-", X, Y), [{"a": X, "b": Y}]),
    ("a + b", both("+", X, Y), [{"a": X, "b": Y}, {"a": Y, "b": X}]),
    ("a - a", both("-", X, Y), []),
    ("a - a", both("-", X, X), [{"a": X}]),
    ("a - 2", both("-", X, TWO), [{"a": X}]),
    ("a - 2", both("-", TWO, X), []),
    ("a * 2", both("*", TWO, X), [{"a": X}]),
    ("-a", both("-", X, Y), []),
    ("-a", ir.Unary(F32, "negate", X), [{"a": X}]),
    ("sqrt(a)", call("sqrt", X), [{"a": X}]),
    ("sqrt(a)", call("exp", X), []),
    ("sqrt(a, b)", call("sqrt", X), []),
    ("clamp(a, b)", call("clamp", X, Y, TWO), []),
    ("clamp(a, b, 2)", call("clamp", X, Y, TWO), [{"a": X, "b": Y}]),
    ("max(a, max(a, b))", call("max", call("max", X, Y), Y), [{"a": Y, "b": X}]),
    ("a if c else b", ir.Select(F32, P, X, Y), [{"c": P, "a": X, "b": Y}]),
    ("a and b", both("and", P, Q, BOOL), [{"a": P, "b": Q}, {"a": Q, "b": P}]),
    ("a / b", V, []),
]


@pytest.mark.parametrize(
    ("text", "value", "ways"), FITS, ids=[f"{t}-{k}" for k, (t, _, _) in enumerate(FITS)]
)
def test_value_fits_in_these_ways(text: str, value: ir.Expr, ways: list[dict[str, ir.Expr]]) -> None:
    pattern = patterns.parse(text)
    assert list(patterns.match(pattern, value)) == ways
    if isinstance(pattern, Operation) and patterns.operation(value) == pattern.op and ways:
        assert patterns.may_match(pattern, patterns.outlines(value))


def test_what_is_known_of_a_name_holds() -> None:
    assert list(patterns.match(x, Y, {"x": Y})) == [{"x": Y}]
    assert list(patterns.match(x, Y, {"x": X})) == []
    assert list(patterns.match(Number(2), TWO, {"x": X})) == [{"x": X}]


LOOKED_AT: list[tuple[str, ir.Expr, bool]] = [
    ("sqrt(a) - 1", both("-", call("sqrt", X), ir.Const(F32, 1.0)), True),
    ("sqrt(a) - 1", both("-", call("sqrt", X), Y), False),
    ("sqrt(a) - 1", both("-", ir.Const(F32, 1.0), call("sqrt", X)), False),
    ("sqrt(a) - 1", both("-", call("exp", X), ir.Const(F32, 1.0)), False),
    ("sqrt(a) + 1", both("+", ir.Const(F32, 1.0), call("sqrt", X)), True),
    ("exp(a) * exp(b)", both("*", call("exp", X), Y), False),
    ("a - a", both("-", X, X), True),
    ("a - a", both("-", X, Y), False),
    ("max(a, a)", call("max", X, Y), False),
    ("clamp(a, b, a)", call("clamp", X, Y, X), True),
    ("clamp(a, b, a)", call("clamp", X, Y, TWO), False),
    ("clamp(a, b, b)", call("clamp", X, Y, X), False),
    ("clamp(a, b, b)", call("clamp", X, Y, Y), True),
    ("clamp(a, 0, 0)", call("clamp", X, ir.Const(F32, 0.0), ir.Const(F32, -0.0)), True),
    *((f"a * {k}", both("*", X, ir.Const(F32, float(k))), True) for k in (0, 1, -1, 2)),
    *((f"a * {k}", both("*", X, TWO), False) for k in (0, 1, -1)),
    *((f"a * {k}", both("*", X, ir.Const(F32, -float(k))), False) for k in (1, -1)),
    ("a * 2", both("*", X, ir.Const(F32, 1.0)), False),
    ("a + 0", both("+", V, ir.Construct(VEC3, (ir.Const(F32, 0.0),)), VEC3), True),
    ("a + 0", both("+", V, ir.Construct(VEC3, (TWO,)), VEC3), False),
    ("a + 0", both("+", V, ir.Construct(VEC3, (ir.Const(F32, 0.0), TWO, TWO)), VEC3), False),
    ("a and True", both("and", ir.Const(BOOL, True), P, BOOL), True),
    ("a and True", both("and", P, ir.Const(BOOL, False), BOOL), False),
    ("a and True", both("and", P, Q, BOOL), False),
    ("a if not c else b", ir.Select(F32, P, X, Y), False),
    ("a if not c else b", ir.Select(F32, ir.Unary(BOOL, "not", P), X, Y), True),
]


@pytest.mark.parametrize(("text", "value", "may"), LOOKED_AT)
def test_quick_look_tells_what_plainly_does_not_fit(text: str, value: ir.Expr, may: bool) -> None:
    pattern = patterns.parse(text)
    assert isinstance(pattern, Operation)
    assert patterns.may_match(pattern, patterns.outlines(value)) == may
    assert bool(list(patterns.match(pattern, value))) == may


def test_operations_have_their_words_and_leaves_have_none() -> None:
    found = [patterns.operation(e) for e in (both("+", X, Y), call("max", X, Y), ir.Unary(F32, "negate", X))]
    assert found == ["+", "max", "negate"]
    assert patterns.operation(ir.Select(F32, P, X, Y)) == "select"
    for e in (X, TWO, ir.Swizzle(F32, V, "x"), ir.Convert(F32, N)):
        assert patterns.operation(e) is None


def made(text: str, type_: Type, **given: ir.Expr) -> ir.Expr:
    return patterns.make(patterns.parse(text), given, Values(), type_)


def number(value: float, type_: Type = F32) -> ir.Expr:
    one = ir.Const(F32, value)
    return one if type_ == F32 else ir.Construct(type_, (one,))


MADE: list[tuple[str, Type, dict[str, ir.Expr], ir.Expr]] = [
    ("a", VEC3, {"a": X}, ir.Construct(VEC3, (X,))),
    ("1", F32, {}, number(1.0)),
    ("1", VEC2, {}, number(1.0, VEC2)),
    ("a - 1", F32, {"a": X}, both("-", X, number(1.0))),
    ("a - 1", VEC3, {"a": V}, both("-", V, number(1.0, VEC3), VEC3)),
    ("1 - a", VEC3, {"a": V}, both("-", number(1.0, VEC3), V, VEC3)),
    ("a * b", VEC3, {"a": X, "b": V}, both("*", X, V, VEC3)),
    ("b * a", VEC3, {"a": X, "b": V}, both("*", V, X, VEC3)),
    ("max(a, b)", VEC3, {"a": X, "b": V}, call("max", ir.Construct(VEC3, (X,)), V)),
    ("max(a, b)", VEC3, {"a": V, "b": X}, call("max", V, ir.Construct(VEC3, (X,)))),
    (
        "clamp(a, 0, b)",
        VEC3,
        {"a": X, "b": V},
        call("clamp", ir.Construct(VEC3, (X,)), number(0.0, VEC3), V),
    ),
    ("sqrt(4)", F32, {}, call("sqrt", number(4.0))),
    ("exp(2) * 3", F32, {}, both("*", call("exp", number(2.0)), number(3.0))),
    ("-a", VEC3, {"a": V}, ir.Unary(VEC3, "negate", V)),
    ("not a", BOOL, {"a": P}, ir.Unary(BOOL, "not", P)),
    ("a < 2", BOOL, {"a": X}, both("<", X, TWO, BOOL)),
    ("2 > a", BOOL, {"a": X}, both(">", TWO, X, BOOL)),
    ("n & 2", U32, {"n": N}, both("&", N, ir.Const(U32, 2), U32)),
    ("dot(a, a)", F32, {"a": V}, ir.Builtin(F32, "dot", (V, V))),
    ("a if c else 0", VEC3, {"a": V, "c": P}, ir.Select(VEC3, P, V, number(0.0, VEC3))),
    ("0 if a < 2 else b", F32, {"a": X, "b": Y}, ir.Select(F32, both("<", X, TWO, BOOL), number(0.0), Y)),
    (
        "dot(exp(2) * a, a)",
        F32,
        {"a": V},
        ir.Builtin(F32, "dot", (both("*", call("exp", number(2.0)), V, VEC3), V)),
    ),
]


@pytest.mark.parametrize(("text", "type_", "given", "wanted"), MADE, ids=[row[0] for row in MADE])
def test_value_is_made_of_parts(text: str, type_: Type, given: dict[str, ir.Expr], wanted: ir.Expr) -> None:
    assert made(text, type_, **given) == wanted


@pytest.mark.parametrize(
    ("op", "operands"), [("dot", (X, Y)), ("max", (X, N)), ("+", (X, K)), ("not", (X,)), ("max", (V, N))]
)
def test_operands_that_do_not_go_together_are_refused(op: str, operands: tuple[ir.Expr, ...]) -> None:
    with pytest.raises(ValueError, match="has no such operands"):
        patterns.apply(Values(), op, operands)
