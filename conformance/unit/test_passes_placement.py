"""Where values are computed, what is dead, and how many operations that takes: flows built by hand.

Plan. The parameters x y z are scalars, v w vectors; a flow is a few branches and loops over them.
  trivial   what costs nothing to repeat
  homes     a value is computed as late as its uses allow, outside loops that it does not need
  names     used twice, moved, handed on with others, long, or named by the source
  dead      branches, loops and what they carry, where nothing needs them
  choices   a branch becomes a select where what only one side needs weighs no more than a few products
  written   the statements of each flow, line by line, and their operations counted twice over
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from codegen.backends import dialect
from codegen.emit.stmt import StmtPrinter
from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, VEC2, VEC3
from codegen.ir.verify import verify
from codegen.passes.analysis.operations import operations
from codegen.passes.placement.branches import select_is_cheaper
from codegen.passes.placement.common import named_values
from codegen.passes.placement.counted import operations_of
from codegen.passes.placement.dead import pruned, used_parameters
from codegen.passes.placement.regions import is_trivial, place
from codegen.passes.placement.schedule import statements
from codegen.passes.ssa.flow import Branch, Flow, Item, Loop, Merge, roots
from codegen.passes.ssa.values import FIELD, LOCAL, PARAMETER, Values
from conformance.unit.support.flows import (
    ARRAY,
    ONE,
    PARAMETERS,
    TWO,
    A,
    N,
    P,
    S,
    V,
    W,
    X,
    Y,
    Z,
    branch,
    chain,
    leaf,
    loop,
    made,
    plus,
    root_of,
)
from conformance.unit.support.trees import function_of, no_function

GLSL = StmtPrinter(dialect("glsl", None))
FREE: tuple[ir.Expr, ...] = (
    *(ONE, X, ir.Swizzle(F32, V, "x"), ir.Member(F32, S, "first"), ir.Unary(F32, "negate", X)),
    *(
        ir.Unary(F32, "negate", ONE),
        ir.Index(F32, A, TWO),
        ir.Index(F32, A, N),
        ir.Construct(VEC2, (ONE, ONE)),
    ),
)
COSTLY: tuple[ir.Expr, ...] = (
    *(ir.Unary(F32, "negate", ir.Binary(F32, "+", X, Y)), ir.Unary(BOOL, "not", P)),
    *(ir.Index(F32, A, ir.Binary(I32, "+", N, TWO)), ir.Index(F32, ir.Construct(ARRAY, (X, Y)), TWO)),
    *(ir.Construct(VEC2, (ONE, X)), ir.Construct(ARRAY, (ONE, ONE)), ir.Binary(F32, "+", X, Y)),
    *(ir.Builtin(F32, "abs", (X,)), ir.Select(F32, P, X, Y), ir.Convert(F32, N), ir.Call(F32, "f", ())),
)
TRIVIAL = [(e, True) for e in FREE] + [(e, False) for e in COSTLY]


@pytest.mark.parametrize(("e", "trivial"), TRIVIAL, ids=str)
def test_what_costs_nothing(e: ir.Expr, trivial: bool) -> None:
    assert is_trivial(e) == trivial


def text(values: Values, items: list[Item], result: ir.Expr) -> list[str]:
    """The statements; their operations are those that are counted without writing them."""
    flow = Flow(items, result)
    body, origins = statements(values, flow, result.type, PARAMETERS, 10)
    known = tuple(values.parameters.values())
    plain = function_of(X, "f", Place("", 1))
    function = replace(plain, parameters=known, returns=result.type, body=body)
    verify(function, no_function)
    found = list(ir.statements(body))
    assigned = {s.name for s in found if isinstance(s, ir.Assign)}
    assert {s.name for s in found if isinstance(s, ir.Let) and s.mutable} == assigned
    assert operations_of(values, flow, result.type) == sum(operations(function).values())
    numbers = [s.line for s in found]
    assert sorted(numbers) == list(range(11, 11 + len(numbers)))
    assert set(origins) <= set(numbers)
    assert set(origins.values()) <= {("f", 1)}
    return [line.strip() for line in GLSL.block(body, "")]


def test_what_one_side_needs_is_computed_there() -> None:
    values = made()
    item = branch(values, P, [("y_next", root_of(values, X), ONE)])
    out = leaf(values, "y_next@merged")
    assert text(values, [item], plus(values, out, X)) == [
        *("float y_next = 0.0;", "if (p) {", "y_next = sqrt(x);", "} else {", "y_next = 1.0;", "}"),
        "return y_next + x;",
    ]
    values = made()
    total = plus(values, X, Y)
    item = branch(values, P, [("t", values.binary("*", total, total), ONE)])
    assert text(values, [item], leaf(values, "t@merged"))[1:4] == [
        *("if (p) {", "float sum = x + y;", "t = sum * sum;")
    ]
    item = branch(values, P, [("t", ONE, root_of(values, X))])
    assert text(values, [item], leaf(values, "t@merged"))[-4:] == [
        *("} else {", "t = sqrt(x);", "}", "return t;")
    ]


def test_what_both_sides_need_is_computed_before() -> None:
    values = made()
    root = root_of(values, X)
    sides = plus(values, root, Y), values.binary("*", root, Z)
    item = branch(values, P, [("t", *sides)])
    assert text(values, [item], leaf(values, "t@merged")) == [
        *("float root = sqrt(x);", "float t = 0.0;", "if (p) {", "t = root + y;", "} else {"),
        *("t = root * z;", "}", "return t;"),
    ]
    placement = place(Flow([item], leaf(values, "t@merged")), leaf(values, "t@merged"))
    then, orelse = placement.root.inner[id(item)]
    assert placement.homes[id(root)] is placement.root
    assert placement.homes[id(sides[0])] is then
    assert placement.homes[id(sides[1])] is orelse
    assert placement.uses[id(root)] == 2
    assert not placement.moved
    assert [r.depth for r in (placement.root, then, orelse)] == [0, 1, 1]
    assert list(then.ancestors()) == [then, placement.root]


def nested() -> tuple[Values, Loop, Loop, dict[str, ir.Expr]]:
    """for i: t = t + x; for j: q = q * (sqrt(x) + sqrt(t)) + sqrt(q)"""
    values = made()
    t, q = leaf(values, "t@in"), leaf(values, "q@in")
    parts = {"x": root_of(values, X), "t": root_of(values, t), "q": root_of(values, q)}
    scaled = values.binary("*", q, plus(values, parts["x"], parts["t"]))
    inner = loop(values, "j", [], [("q", X, plus(values, scaled, parts["q"]))])
    outer = loop(values, "i", [inner], [("t", X, plus(values, t, leaf(values, "q@out")))])
    return values, outer, inner, parts


def test_values_leave_the_loops_that_they_do_not_need() -> None:
    values, outer, inner, parts = nested()
    placement = place(Flow([outer], leaf(values, "t@out")), leaf(values, "t@out"))
    (body,) = placement.root.inner[id(outer)]
    (innermost,) = body.inner[id(inner)]
    assert placement.homes[id(parts["x"])] is placement.root
    assert placement.homes[id(parts["t"])] is body
    assert placement.homes[id(parts["q"])] is innermost
    moved = values.binary("+", parts["x"], parts["t"])
    assert placement.homes[id(moved)] is body
    assert placement.moved == {id(parts["x"]), id(moved)}
    assert body.is_loop and innermost.is_loop and not placement.root.is_loop
    positions = {id(e): k for k, e in enumerate(placement.order)}
    assert all(positions[id(e)] < positions[id(c)] for e in placement.order for c in ir.children(e))
    lines = text(values, [outer], leaf(values, "t@out"))
    assert lines.index("float root = sqrt(x);") < lines.index("for (int i = 2; i < 5; i++) {")
    assert lines[-1] == "return t;"


def test_a_loop_hands_on_what_was_before() -> None:
    """Both are computed before either is assigned; what is a variable alone is copied."""
    values = made()
    t, q = leaf(values, "t@in"), leaf(values, "q@in")
    item = loop(values, "i", [], [("t", X, q), ("q", Y, values.binary("*", t, q))])
    assert text(values, [item], plus(values, leaf(values, "t@out"), leaf(values, "q@out"))) == [
        *("float t = x;", "float q = y;", "for (int i = 2; i < 5; i++) {", "float scaled = t * q;"),
        *("float t_2 = q;", "t = t_2;", "q = scaled;", "}", "return t + q;"),
    ]


def test_one_value_that_a_loop_hands_on_needs_no_name() -> None:
    values = made()
    t = leaf(values, "t@in")
    limit = values.intern(N)
    item = loop(values, "i", [], [("t", X, plus(values, t, Y))], limit)
    lines = text(values, [item], leaf(values, "t@out"))
    assert lines[0] == "float t = x;"
    assert "t = t + y;" in lines
    assert "for (int i = 0; i < min(n, 5); i++) {" in lines
    item = replace(item, limit=values.intern(ir.Binary(I32, "+", N, TWO)))
    assert "for (int i = 0; i < min(n + 2, 5); i++) {" in text(values, [item], leaf(values, "t@out"))
    copied = loop(values, "i", [], [("t", X, Y)])
    assert "t = y;" in text(values, [copied], leaf(values, "t@out"))


def test_branches_in_loops_and_loops_in_branches() -> None:
    values = made()
    t = leaf(values, "t@in")
    inside = branch(values, values.build(ir.Binary(BOOL, "<", t, X)), [("m", root_of(values, Y), t)])
    repeated = loop(values, "i", [inside], [("t", X, plus(values, t, leaf(values, "m@merged")))])
    lines = text(values, [repeated], leaf(values, "t@out"))
    assert lines[:2] == ["float root = sqrt(y);", "float t = x;"]
    values = made()
    t = leaf(values, "t@in")
    within = loop(values, "i", [], [("t", X, plus(values, t, root_of(values, Y)))])
    outer = branch(values, P, [("m", leaf(values, "t@out"), Z)], then=[within])
    lines = text(values, [outer], leaf(values, "m@merged"))
    assert lines.index("if (p) {") < lines.index("float root = sqrt(y);") < lines.index("} else {")


def test_truth_values_and_vectors_start_as_false_and_zero() -> None:
    values = made()
    flag = values.intern(ir.Var(BOOL, "flag@merged"))
    place_ = values.intern(ir.Var(VEC3, "place@merged"))
    assert isinstance(flag, ir.Var) and isinstance(place_, ir.Var)
    less = values.build(ir.Binary(BOOL, "<", X, Y))
    item = Branch(P, [], [], [Merge(flag, "flag", less, P), Merge(place_, "place", V, W)])
    lines = text(values, [item], values.build(ir.Select(VEC3, flag, place_, V)))
    assert lines[:2] == ["bool flag = false;", "vec3 place = vec3(0.0);"]
    assert lines[3:8] == ["flag = x < y;", "place = v;", "} else {", "flag = p;", "place = w;"]


def test_values_are_defined_in_the_order_of_their_use() -> None:
    values = made()
    one, other = (values.binary("*", e, e) for e in (plus(values, X, Y), values.binary("*", X, Z)))
    assert text(values, [], values.binary("-", one, other)) == [
        *("float sum = x + y;", "float scaled = x * z;", "return sum * sum - scaled * scaled;")
    ]


def is_named(values: Values, items: list[Item], result: ir.Expr, e: ir.Expr) -> bool:
    return id(e) in named_values(values, place(Flow(items, result), result))


def test_a_value_that_is_used_twice_has_a_name() -> None:
    values = made()
    once, twice = values.binary("*", X, Y), plus(values, X, Y)
    result = values.binary("/", values.binary("-", once, twice), plus(values, twice, Z))
    assert is_named(values, [], result, twice)
    assert not is_named(values, [], result, once)
    square = values.binary("*", twice, twice)
    assert is_named(values, [], square, twice)
    swizzled = values.build(ir.Builtin(VEC3, "cross", (V, W)))
    parts = [values.component(swizzled, k) for k in (0, 0, 1)]
    assert place(Flow([], plus(values, *parts)), plus(values, *parts)).uses[id(swizzled)] == 3


@pytest.mark.parametrize(
    ("rank", "count", "named"),
    [(LOCAL, 3, True), (LOCAL, 2, False), (FIELD, 6, True), (FIELD, 5, False), (PARAMETER, 14, False),
     (PARAMETER, 15, True), (0, 14, False), (0, 15, True)],
)  # fmt: skip
def test_names_from_the_source_are_kept_from_a_size_on(rank: int, count: int, named: bool) -> None:
    values = made()
    e = chain(values, X, count)
    if rank:
        values.hint(e, "mine", rank)
    assert is_named(values, [], root_of(values, e), e) == named
    assert not is_named(values, [], e, e)


def test_what_has_a_name_counts_no_more_in_what_uses_it() -> None:
    values = made()
    shared = chain(values, X, 10)
    over = chain(values, plus(values, shared, root_of(values, shared)), 6)
    assert not is_named(values, [], root_of(values, over), over)
    alone = chain(values, chain(values, X, 9), 6)
    assert is_named(values, [], root_of(values, alone), alone)


def test_vectors_are_named_where_they_are_used_twice_and_arrays_always() -> None:
    values = made()
    pair, ones = (values.build(ir.Construct(VEC3, (e, ONE, ONE))) for e in (X, ONE))
    both = values.build(ir.Builtin(F32, "dot", (pair, values.binary("+", pair, ones))))
    assert is_named(values, [], both, pair)
    assert not is_named(values, [], both, ones)
    single = values.build(ir.Builtin(F32, "dot", (pair, V)))
    assert not is_named(values, [], single, pair)
    array = values.build(ir.Construct(ARRAY, (X, Y)))
    assert is_named(values, [], values.build(ir.Index(F32, array, N)), array)


def names_of(items: list[Item]) -> list[str]:
    """Loops and branches by what they leave behind, nested ones in brackets."""
    shown: list[str] = []
    for item in items:
        if isinstance(item, Branch):
            inner = ["(", *names_of(item.then), "|", *names_of(item.orelse), ")"]
            shown += [*(m.name for m in item.merges), *inner]
        else:
            shown += [*(c.name for c in item.carried), "[", *names_of(item.body), "]"]
    return shown


def test_what_nothing_needs_is_dead() -> None:
    values, outer, inner, _ = nested()
    t, q = leaf(values, "t@out"), leaf(values, "q@out")
    assert names_of(pruned(Flow([outer], t)).items) == ["t", "[", "q", "[", "]", "]"]
    assert names_of(pruned(Flow([outer], X)).items) == []
    alone = replace(outer, carried=[replace(outer.carried[0], following=X)])
    assert names_of(pruned(Flow([alone], t)).items) == ["t", "[", "]"]
    both = replace(inner, carried=[*inner.carried, *loop(values, "k", [], [("r", X, Y)]).carried])
    assert names_of(pruned(Flow([both], q)).items) == ["q", "[", "]"]
    assert names_of(pruned(Flow([both], plus(values, q, leaf(values, "r@out")))).items) == [
        "q",
        "r",
        "[",
        "]",
    ]
    sides = branch(values, P, [("a1", t, X), ("a2", Y, X)], then=[outer], orelse=[inner])
    first, second = leaf(values, "a1@merged"), leaf(values, "a2@merged")
    assert names_of(pruned(Flow([sides], first)).items) == [
        "a1",
        "(",
        "t",
        "[",
        "q",
        "[",
        "]",
        "]",
        "|",
        *"q[]",
        ")",
    ]
    assert names_of(pruned(Flow([sides], second)).items) == ["a2", "(", "|", ")"]
    assert names_of(pruned(Flow([sides], {"part": second, "other": X})).items) == ["a2", "(", "|", ")"]
    assert names_of(pruned(Flow([sides], Z)).items) == []
    decided = branch(values, values.build(ir.Binary(BOOL, "<", q, X)), [("c", Y, Z)])
    kept = pruned(Flow([inner, decided], leaf(values, "c@merged")))
    assert names_of(kept.items) == ["q", "[", "]", "c", "(", "|", ")"]
    t_in = leaf(values, "t@in")
    handed = loop(values, "k", [], [("t", X, Y), ("r", X, t_in)])
    assert names_of(pruned(Flow([handed], leaf(values, "r@out"))).items) == ["t", "r", "[", "]"]
    start = loop(values, "k", [], [("r", q, Y)])
    assert names_of(pruned(Flow([inner, start], leaf(values, "r@out"))).items) == [*"q[]r[]"]


def test_parameters_that_values_use() -> None:
    values = made()
    assert used_parameters(values, [values.binary("*", Z, plus(values, X, Z)), P]) == ["x", "z", "p"]
    assert used_parameters(values, [leaf(values, "nobody")]) == []


def test_every_value_of_a_flow() -> None:
    values, outer, inner, _ = nested()
    item = branch(values, P, [("m", X, Y)], then=[inner], orelse=[replace(outer, limit=N)])
    found = list(roots([item]))
    assert found[0] is P
    for e in (X, Y, N, inner.carried[0].following, outer.carried[0].following):
        assert any(f is e for f in found)
    assert len(found) == 1 + 2 + (1 + 2 + 2) + 2


def test_a_choice_of_little_weight_is_a_select() -> None:
    values = made()
    for count, cheap in ((12, True), (13, False)):
        for sides in ((chain(values, X, count), Y), (Y, chain(values, X, count))):
            assert select_is_cheaper(branch(values, P, []), *sides) == cheap
    for count, cheap in ((4, True), (5, False)):
        assert select_is_cheaper(branch(values, P, []), root_of(values, chain(values, X, count)), Y) == cheap
    assert select_is_cheaper(branch(values, P, []), chain(values, X, 6), chain(values, Z, 6))
    assert not select_is_cheaper(branch(values, P, []), chain(values, X, 6), chain(values, Z, 7))
    shared = root_of(values, root_of(values, X))
    assert select_is_cheaper(branch(values, P, []), plus(values, shared, Y), plus(values, shared, Z))
    inner = loop(values, "i", [], [("t", X, Y)])
    assert not select_is_cheaper(branch(values, P, [], then=[inner]), X, Y)
    assert not select_is_cheaper(branch(values, P, [], orelse=[inner]), X, Y)
