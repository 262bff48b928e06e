"""Values of one flow: which are one value, how a report shows them, and the names that locals get.

Plan.
  one value  operands of commutative operations in either order; whatever else differs is another value;
             each is simplified once by the rules that hold
  short      what makes and takes apart values, and everything that a flow uses
  log        a step is noted once for a place, again for another
  text       every kind of expression as a person writes it, to a depth, with names for what has one
  names      every operation on floats has a word of its own, that says what its result is; names are given
             once, none that is reserved anywhere
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from codegen.evaluate.arrays import arithmetic
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, VEC2, VEC3, Field, Struct, array_of
from codegen.names import reserved
from codegen.ops import BUILTINS, OPERATORS
from codegen.passes.placement.common import Names
from codegen.passes.rules.fold import constants
from codegen.passes.ssa.flow import Branch, Carried, Loop, Merge, roots
from codegen.passes.ssa.text import DEPTH, show
from codegen.passes.ssa.values import (
    CALL,
    FIELD,
    LOCAL,
    PARAMETER,
    Rewrite,
    Values,
    any_element,
    constant_components,
    leaves,
)

PAIR = Struct("Pair", (Field("first", F32), Field("second", VEC3)))
ARRAY = array_of(F32, 3)
X, Y, V, W = ir.Var(F32, "x"), ir.Var(F32, "y"), ir.Var(VEC3, "v"), ir.Var(VEC3, "w")
N, K, P = ir.Var(U32, "n"), ir.Var(I32, "k"), ir.Var(BOOL, "p")
A, S = ir.Var(ARRAY, "a"), ir.Var(PAIR, "s")
ONE = ir.Const(F32, 1.0)
THREE: tuple[ir.Expr, ...] = X, Y, ONE
SUM, QUOTIENT = ir.Binary(F32, "+", X, Y), ir.Binary(F32, "/", X, Y)

DISTINCT: tuple[ir.Expr, ...] = (
    *(X, Y, V, N, ONE, ir.Const(F32, 2.0), ir.Const(F32, -1.0), ir.Const(I32, 1), ir.Const(U32, 1)),
    *(ir.Const(BOOL, True), ir.Const(BOOL, False)),
    *(ir.Binary(F32, op, X, Y) for op in "+-*/"),
    *(ir.Binary(F32, op, Y, X) for op in "-/"),
    *(ir.Binary(BOOL, op, X, Y) for op in ("<", "<=", ">", ">=", "==", "!=")),
    *(ir.Builtin(F32, op, (X, Y)) for op in ("min", "max", "atan2")),
    ir.Builtin(F32, "atan2", (Y, X)),
    *(ir.Builtin(F32, op, (X,)) for op in ("sin", "cos", "abs")),
    *(ir.Builtin(F32, "sin", (Y,)), ir.Unary(F32, "negate", X), ir.Unary(F32, "negate", Y)),
    *(ir.Builtin(F32, "clamp", parts) for parts in itertools.permutations(THREE)),
    *(ir.Call(F32, name, parts) for name in ("f", "g") for parts in ((X, Y), (Y, X), (X,))),
    *(ir.Member(F32, S, "first"), ir.Member(VEC3, S, "second")),
    *(ir.Swizzle(F32, V, c) for c in "xyz"),
    *(ir.Swizzle(VEC2, V, c) for c in ("xy", "yx")),
    *(ir.Construct(VEC2, parts) for parts in ((X, Y), (Y, X), (X,))),
    *(ir.Construct(VEC3, (X,)), ir.Index(F32, A, K), ir.Index(F32, A, ir.Const(I32, 0))),
    *(ir.Select(F32, P, X, Y), ir.Select(F32, P, Y, X)),
    *(ir.Convert(F32, N), ir.Convert(I32, N), ir.Convert(F32, K)),
    *(ir.Builtin(VEC3, "cross", pair) for pair in ((V, W), (W, V))),
)


def rebuilt(values: Values, e: ir.Expr) -> ir.Expr:
    """A copy of the tree, as a value."""
    parts = tuple(rebuilt(values, part) for part in ir.children(e))
    return values.intern(ir.rebuild(e, parts) if parts else replace(e))


def test_whatever_differs_is_another_value() -> None:
    values = Values()
    first = [rebuilt(values, e) for e in DISTINCT]
    again = [rebuilt(values, e) for e in DISTINCT]
    assert all(a is b for a, b in zip(first, again, strict=True))
    assert len({id(e) for e in first}) == len(DISTINCT)


def is_symmetric(op: str) -> bool:
    """Whether an operator gives the same for exchanged operands, by what the registry says that it means."""
    m = arithmetic("float64").namespace
    types = {types[0] for types, _ in OPERATORS[op].rule}
    first, second = {
        F32: (np.array([1.5, -2.0, 0.25]), np.array([0.5, 3.0, -4.0])),
        U32: (np.array([9, 29, 5], np.uint32), np.array([3, 1, 5], np.uint32)),
        BOOL: (np.array([True, True, False]), np.array([True, False, True])),
    }[next(t for t in (F32, U32, BOOL) if t in types)]
    meaning = OPERATORS[op].meaning
    return np.array_equal(meaning(m, first, second), meaning(m, second, first))


def test_either_order_is_one_value_where_it_is_the_same() -> None:
    values = Values()
    binary = [op for op in OPERATORS if {len(types) for types, _ in OPERATORS[op].rule} == {2}]
    assert {"-", "/", "and", "^", "<<"} <= set(binary)
    for op in binary:
        a, b = (values.intern(ir.Binary(F32, op, *pair)) for pair in ((X, Y), (Y, X)))
        assert (a is b) == is_symmetric(op), op
    for op in ("min", "max", "dot"):
        a, b = (values.intern(ir.Builtin(F32, op, pair)) for pair in ((V, W), (W, V)))
        assert a is b


def test_values_are_simplified_once_and_anew_by_other_rules() -> None:
    met: list[ir.Expr] = []

    def meeting(values: Values, e: ir.Expr) -> Rewrite | None:
        met.append(e)
        return None

    values = Values(rules=(meeting,))
    twice = [values.build(ir.Binary(F32, "+", *pair)) for pair in ((X, Y), (X, Y), (Y, X))]
    assert met == [SUM]
    assert twice[0] is twice[1] is twice[2]
    values.simplify_by((meeting,))
    values.build(SUM)
    assert met == [SUM, SUM]
    three = ir.Binary(F32, "+", ONE, ir.Const(F32, 2.0))
    assert values.build(three) == three
    values.simplify_by((constants,))
    assert values.build(three) == ir.Const(F32, 3.0)


def test_a_tree_that_shares_its_parts_is_walked_once() -> None:
    class Counting(Values):
        count = 0

        def build(self, e: ir.Expr) -> ir.Expr:
            self.count += 1
            return super().build(e)

    tree: ir.Expr = X
    for _ in range(8):
        tree = ir.Binary(F32, "*", tree, tree)
    values = Counting()
    assert values.rebuild(tree) == tree
    assert values.count == 9


def test_kept_calls_and_their_fields_are_told_apart() -> None:
    values = Values()
    calls = [values.build(ir.Call(PAIR, name, (X,))) for name in ("f", "g")]
    assert calls[0] is not calls[1]
    fields = [values.build(ir.Member(F32, ir.Call(PAIR, "f", (X,)), name)) for name in ("first", "second")]
    assert fields[0] is not fields[1]
    swizzles = [values.build(ir.Swizzle(VEC2, V, c)) for c in ("xy", "yx")]
    assert swizzles[0] is not swizzles[1]
    assert values.build(ir.Const(F32, 1.0)) is not values.build(ir.Const(I32, 1))
    assert values.build(ir.Const(BOOL, True)) is not values.build(ir.Const(I32, 1))
    assert values.build(ir.Const(F32, 0.0)) is not values.build(ir.Const(F32, -0.0))


def test_short_ways_to_values() -> None:
    values = Values()
    for op, a, b in (("*", V, X), ("*", X, V), ("+", V, W)):
        assert Values().binary(op, a, b) == ir.Binary(VEC3, op, a, b)
    assert values.binary("<", X, Y, BOOL) == ir.Binary(BOOL, "<", X, Y)
    assert [values.component(V, k) for k in range(3)] == [ir.Swizzle(F32, V, c) for c in "xyz"]
    assert values.component(X, 2) is X
    assert values.splat(X, VEC3) == ir.Construct(VEC3, (X,))
    assert values.splat(V, VEC3) is V
    assert values.splat(X, F32) is X
    assert values.splat(N, VEC3) is N
    assert values.number(2, F32) == ir.Const(F32, 2.0)
    assert values.number(2, VEC2) == ir.Construct(VEC2, (ir.Const(F32, 2.0),))
    assert repr(constant_components(values.number(2, F32))) == "(2.0,)"
    assert repr(constant_components(values.number(2, U32))) == "(2,)"


def test_parts_of_a_value_in_order() -> None:
    assert list(leaves(X)) == [X]
    assert list(leaves({"a": X, "b": {"c": V, "d": Y}, "e": N})) == [X, V, Y, N]


def test_components_of_constants() -> None:
    two = ir.Const(F32, 2.0)
    assert constant_components(ONE) == (1.0,)
    assert constant_components(ir.Construct(VEC3, (two,))) == (2.0, 2.0, 2.0)
    assert constant_components(ir.Construct(VEC2, (ONE, two))) == (1.0, 2.0)
    for e in (X, ir.Construct(VEC2, (ONE, X)), ir.Construct(PAIR, (ONE, two)), SUM):
        assert constant_components(e) is None


def test_everything_that_a_flow_uses_in_order() -> None:
    """Of a loop without a limit inside a branch inside a loop with one."""

    def leaf(k: int) -> ir.Var:
        return ir.Var(F32, f"leaf@{k}")

    def value(k: int) -> ir.Expr:
        return ir.Const(F32, float(k))

    inner = Loop(leaf(0), "j", 0, 3, None, [], [Carried(leaf(1), leaf(2), "y", value(2), value(3))])
    branch = Branch(value(1), [inner], [], [Merge(leaf(3), "z", value(4), value(5))])
    outer = Loop(leaf(4), "i", 0, 9, value(0), [branch], [Carried(leaf(5), leaf(6), "x", value(6), value(7))])
    assert list(roots([outer])) == [value(k) for k in range(8)]
    swapped = Branch(value(0), [], [inner], [])
    assert list(roots([swapped, outer]))[:4] == [value(0), value(2), value(3), value(0)]
    assert list(roots([])) == []


def test_a_step_outside_of_any_function() -> None:
    values = Values()
    values.note("fold", "1 + 1 -> 2", "exact")
    assert [s.where for s in values.log] == [":0"]


def test_a_step_is_noted_once_for_a_place() -> None:
    values = Values(function="f", line=3)
    for line in (3, 3, 4, 3):
        values.line = line
        values.note("fold", "1 + 1 -> 2", "exact")
    values.note("fold", "1 + 1 -> 2", "another reason")
    assert [(s.where, s.why) for s in values.log] == [
        ("f:3", "exact"),
        ("f:4", "exact"),
        ("f:3", "another reason"),
    ]


def test_rules_that_never_end_are_told() -> None:
    def turn(values: Values, e: ir.Expr) -> Rewrite | None:
        if not isinstance(e, ir.Binary):
            return None
        return Rewrite(values.intern(ir.Binary(F32, e.op, e.right, e.left)), "turn", "for ever")

    values = Values(rules=(turn,))
    with pytest.raises(RuntimeError, match="do not end on x - y"):
        values.binary("-", X, Y)


def test_a_whole_tree_is_simplified_from_its_leaves() -> None:
    values = Values(rules=(constants,))
    tree = ir.Binary(F32, "*", X, ir.Binary(F32, "+", ONE, ir.Binary(F32, "*", ONE, ir.Const(F32, 3.0))))
    assert values.show(values.rebuild(tree)) == "x * 4"


def test_the_name_that_says_most_wins_and_moves_with_the_value() -> None:
    values = Values(rules=(constants,))
    e = values.intern(SUM)
    for name, rank in (("whole", PARAMETER), ("part", FIELD), ("later", FIELD), ("least", PARAMETER)):
        values.hint(e, name, rank)
    assert values.hints[id(e)].name == "part"
    other = values.intern(QUOTIENT)
    for rank, name in enumerate(("called", "given", "held", "mine")):
        values.hint(other, name, (CALL, PARAMETER, FIELD, LOCAL)[rank])
        assert values.hints[id(other)].name == name
    assert values.show(values.intern(ir.Unary(F32, "negate", other))) == "-mine"
    values.hint(e, "mine", LOCAL)
    assert values.hints[id(e)].name == "mine"
    values.hint(X, "parameters need none", LOCAL)
    values.hint(ONE, "nor do constants", LOCAL)
    assert set(values.hints) == {id(e), id(other)}

    def halved(values: Values, e: ir.Expr) -> Rewrite | None:
        if e != SUM:
            return None
        return Rewrite(values.intern(ir.Binary(F32, "*", X, Y)), "other", "for the test")

    values.simplify_by((halved,))
    made = values.build(SUM)
    assert values.hints[id(made)].name == "mine"


SHOWN: dict[str, ir.Expr] = {
    "1": ONE,
    "0.5": ir.Const(F32, 0.5),
    "true": ir.Const(BOOL, True),
    "7": ir.Const(U32, 7),
    "4294967295": ir.Const(U32, 2**32 - 1),
    "-3": ir.Const(I32, -3),
    "x": X,
    "-x": ir.Unary(F32, "negate", X),
    "not p": ir.Unary(BOOL, "not", P),
    "~n": ir.Unary(U32, "~", N),
    "x + y": SUM,
    "-(x + y)": ir.Unary(F32, "negate", SUM),
    "(x + y) - (x / y)": ir.Binary(F32, "-", SUM, QUOTIENT),
    "x if p else y": ir.Select(F32, P, X, Y),
    "(x + y) if (x < y) else (x / y)": ir.Select(F32, ir.Binary(BOOL, "<", X, Y), SUM, QUOTIENT),
    "(x if p else y) + x": ir.Binary(F32, "+", ir.Select(F32, P, X, Y), X),
    "s.first": ir.Member(F32, S, "first"),
    "v.xz": ir.Swizzle(VEC2, V, "xz"),
    "(v + w).y": ir.Swizzle(F32, ir.Binary(VEC3, "+", V, W), "y"),
    "a[2]": ir.Index(F32, A, ir.Const(I32, 2)),
    "a[k + 1]": ir.Index(F32, A, ir.Binary(I32, "+", K, ir.Const(I32, 1))),
    "clamp(x + y, 1, y)": ir.Builtin(F32, "clamp", (SUM, ONE, Y)),
    "f(x, x / y)": ir.Call(F32, "f", (X, QUOTIENT)),
    "vec2(x, y)": ir.Construct(VEC2, (X, Y)),
    "f32(n)": ir.Convert(F32, N),
    "sin(x) * cos(y)": ir.Binary(F32, "*", ir.Builtin(F32, "sin", (X,)), ir.Builtin(F32, "cos", (Y,))),
}


@pytest.mark.parametrize("text", SHOWN)
def test_expression_is_shown_as_it_is_written(text: str) -> None:
    assert show(SHOWN[text]) == text


def test_named_operands_are_shown_by_their_names() -> None:
    whole = ir.Binary(F32, "*", SUM, ir.Unary(F32, "negate", QUOTIENT))
    names = {id(SUM): "total", id(QUOTIENT): "ratio"}
    assert show(whole, lambda e: names.get(id(e))) == "total * -ratio"
    assert show(SUM, lambda e: names.get(id(e))) == "x + y"


def test_whichever_element_of_an_array_is_told() -> None:
    values = Values()
    assert show(any_element(values, A)) == "a[any element]"


def test_what_lies_deep_is_left_out() -> None:
    assert DEPTH == 4, "as the sentences of reports are short"
    e: ir.Expr = X
    for _ in range(DEPTH):
        e = ir.Builtin(F32, "sin", (e,))
    assert show(e) == "sin(" * DEPTH + "x" + ")" * DEPTH
    assert show(ir.Builtin(F32, "cos", (e,))) == "cos(" + "sin(" * (DEPTH - 1) + "..." + ")" * DEPTH
    for make in (
        lambda e: ir.Binary(F32, "+", e, X),
        lambda e: ir.Unary(F32, "negate", e),
        lambda e: ir.Select(F32, P, e, X),
        lambda e: ir.Swizzle(F32, ir.Construct(VEC2, (e,)), "x"),
        lambda e: ir.Call(F32, "f", (e,)),
    ):
        deep: ir.Expr = X
        for _ in range(3 * DEPTH):
            deep = make(deep)
        assert "..." in show(deep)
        assert len(show(deep)) < 100


FLOAT_OPERATIONS = sorted(
    name
    for name, row in {**OPERATORS, **BUILTINS}.items()
    if any(types[0] in (F32, VEC3, BOOL) for types, _ in row.rule) and name != "float_to_bits"
)


def of_operation(name: str) -> ir.Expr:
    if name in BUILTINS:
        return ir.Builtin(F32, name, tuple((X, Y, ONE)[: len(BUILTINS[name].names)]))
    count = len(OPERATORS[name].rule[0][0])
    return ir.Unary(F32, name, X) if count == 1 else ir.Binary(F32, name, X, Y)


@pytest.mark.parametrize("name", FLOAT_OPERATIONS)
def test_every_operation_on_floats_has_a_word(name: str) -> None:
    e = of_operation(name)
    given = Names(()).of(Values(), e)
    assert given not in ("part", "value")
    assert given.isidentifier()
    assert given not in reserved()


def test_words_tell_what_is_computed() -> None:
    """Neighbours in the table have other words, and what has a name of its own keeps it."""
    words = {name: Names(()).of(Values(), of_operation(name)) for name in FLOAT_OPERATIONS}
    for one, other in (("<", ">"), ("<=", ">="), ("+", "-"), ("sin", "cos"), ("min", "max"), ("exp", "log")):
        assert words[one] != words[other]
    names = Names(("chosen",))
    assert names.of(Values(), ir.Select(F32, P, X, Y)) == "chosen_2"
    assert names.of(Values(), ir.Call(F32, "wave", (X,))) == "wave_value"
    assert names.of(Values(), ir.Builtin(F32, "dot", (V, W))) == "v_dot_w"
    assert names.of(Values(), ir.Builtin(F32, "dot", (V, W))) == "v_dot_w_2"
    assert names.of(Values(), ir.Builtin(F32, "dot", (ir.Var(VEC3, "v@1"), W))) == "cosine"
    assert names.of(Values(), ir.Builtin(F32, "dot", (V, ir.Var(VEC3, "w@1")))) == "cosine_2"
    assert names.of(Values(), ir.Convert(F32, N)) == "part"
    values = Values()
    values.hint(SUM, "mine_", LOCAL)
    assert names.of(values, SUM) == "mine"


def test_names_are_given_once_and_none_is_reserved() -> None:
    names = Names(("x", "x_2"))
    assert [names.give("x") for _ in range(3)] == ["x_3", "x_4", "x_5"]
    assert [names.give("y") for _ in range(2)] == ["y", "y_2"]
    assert names.give("_") == "value"
    keyword = "mix"
    assert keyword in reserved()
    assert names.give(keyword) == "mix_value"
