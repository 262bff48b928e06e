"""Single nodes: how many operations each is, what its components are, and its range under every table.

Plan.
  counted     every kind of node by class, per component; of a function also what it calls, by cost
  components  constructions, selections of components, operations on vectors that are alike throughout
  transfer    one operation on ranges that are whole numbers, where every table gives the same ends
  signatures  tables share what they compute of an operation only if they say the same of it and of what it
              inherits from
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from codegen.intervals import TABLES, load_table
from codegen.intervals.accuracy import Scaled, Ulp
from codegen.intervals.operations import VECTOR_BUILTINS
from codegen.intervals.values import Range
from codegen.ir import nodes as ir
from codegen.ir.domains import Interval
from codegen.ir.types import BOOL, F32, I32, U32, UVEC2, VEC2, VEC3, VEC4, Type, array_of
from codegen.passes.analysis import transfer
from codegen.passes.analysis.operations import expression_operations, number_of_operations
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.rules.scalars import components
from codegen.passes.ssa.values import Values

X, Y, Z, T = (ir.Var(F32, name) for name in "xyzt")
V, W, P2, Q = ir.Var(VEC3, "v"), ir.Var(VEC3, "w"), ir.Var(VEC2, "p2"), ir.Var(VEC4, "q")
C, N, K = ir.Var(BOOL, "c"), ir.Var(U32, "n"), ir.Var(I32, "k")
ARRAY = array_of(F32, 3)
A = ir.Var(ARRAY, "a")
ONE, TWO = ir.Const(F32, 1.0), ir.Const(F32, 2.0)

COUNTED: list[tuple[ir.Expr, dict[str, int]]] = [
    (ir.Binary(F32, "+", X, Y), {"arithmetic": 1}),
    (ir.Binary(VEC3, "*", X, V), {"arithmetic": 3}),
    (ir.Binary(VEC3, "*", V, X), {"arithmetic": 3}),
    (ir.Binary(VEC3, "/", V, X), {"special": 3}),
    (ir.Binary(BOOL, "<", X, Y), {"compare": 1}),
    (ir.Binary(BOOL, "<=", X, Y), {"compare": 1}),
    (ir.Binary(BOOL, ">", X, Y), {"compare": 1}),
    (ir.Binary(BOOL, ">=", X, Y), {"compare": 1}),
    (ir.Binary(BOOL, "==", N, N), {"compare": 1}),
    (ir.Binary(BOOL, "!=", N, N), {"compare": 1}),
    (ir.Unary(F32, "negate", X), {}),
    (ir.Builtin(F32, "abs", (X,)), {}),
    (ir.Builtin(VEC3, "max", (V, W)), {"arithmetic": 3}),
    (ir.Builtin(F32, "clamp", (X, Y, Z)), {"arithmetic": 2}),
    (ir.Builtin(VEC3, "clamp", (V, W, V)), {"arithmetic": 6}),
    (ir.Builtin(F32, "dot", (V, W)), {"arithmetic": 5}),
    (ir.Builtin(F32, "dot", (P2, P2)), {"arithmetic": 3}),
    (ir.Builtin(VEC3, "cross", (V, W)), {"arithmetic": 9}),
    (ir.Builtin(F32, "length", (V,)), {"arithmetic": 5, "special": 1}),
    (ir.Builtin(F32, "sqrt", (X,)), {"special": 1}),
    (ir.Builtin(VEC3, "exp", (V,)), {"special": 3}),
    (ir.Select(F32, C, X, Y), {"select": 1}),
    (ir.Select(VEC3, C, V, W), {"select": 3}),
    (ir.Construct(VEC3, (X, Y, Z)), {}),
    (ir.Swizzle(F32, V, "x"), {}),
    (ir.Convert(F32, N), {}),
    (ir.Call(F32, "f", (X,)), {}),
    (ONE, {}),
    (X, {}),
]


@pytest.mark.parametrize(("e", "counts"), COUNTED, ids=str)
def test_operations_of_one_node(e: ir.Expr, counts: dict[str, int]) -> None:
    assert {kind: n for kind, n in expression_operations(e).items() if n} == counts
    assert number_of_operations(e) == sum(counts.values())


def both(type_: Type, op: str, a: ir.Expr, b: ir.Expr) -> ir.Expr:
    return ir.Binary(type_, op, a, b)


def three(*parts: ir.Expr) -> ir.Expr:
    return ir.Construct(VEC3, parts)


def part(e: ir.Expr, letters: str) -> ir.Expr:
    types: dict[int, Type] = {1: F32, 2: VEC2, 3: VEC3, 4: VEC4}
    return ir.Swizzle(types[len(letters)], e, letters)


LEFT: list[tuple[ir.Expr, str]] = [
    (part(three(X, Y, Z), "x"), "x"),
    (part(three(X, Y, Z), "z"), "z"),
    (part(three(X), "y"), "x"),
    (part(three(part(V, "zx"), T), "x"), "v.z"),
    (part(three(part(V, "zx"), T), "y"), "v.x"),
    (part(three(part(V, "zx"), T), "z"), "t"),
    (part(three(T, part(V, "zx")), "y"), "v.z"),
    (part(three(X, Y, Z), "zx"), "vec2(z, x)"),
    (part(three(X, Y, Z), "xx"), "vec2(x)"),
    (part(V, "xyz"), "v"),
    (part(V, "xy"), "v.xy"),
    (part(P2, "xy"), "p2"),
    (part(Q, "xyzw"), "q"),
    (part(Q, "xyz"), "q.xyz"),
    (part(part(V, "zyx"), "zy"), "v.xy"),
    (part(part(Q, "wzyx"), "x"), "q.w"),
    (three(part(V, "x"), part(V, "y"), part(V, "z")), "v"),
    (three(part(V, "z"), part(V, "y"), part(V, "y")), "v.zyy"),
    (three(part(V, "x"), part(V, "y"), part(W, "z")), "vec3(v.x, v.y, w.z)"),
    (three(X, part(V, "y"), part(V, "z")), "vec3(x, v.y, v.z)"),
    (three(part(V, "x"), X, part(V, "z")), "vec3(v.x, x, v.z)"),
    (three(X, X, X), "vec3(x)"),
    (three(X, X, Y), "vec3(x, x, y)"),
    (three(X), "vec3(x)"),
    (three(V), "v"),
    (three(ir.Construct(VEC2, (X, Y)), Z), "vec3(x, y, z)"),
    (three(Z, ir.Construct(VEC2, (X,))), "vec3(z, x, x)"),
    (three(P2, X), "vec3(p2, x)"),
    (both(VEC3, "+", three(X), three(Y)), "vec3(x + y)"),
    (both(VEC3, "/", three(X), three(Y)), "vec3(x / y)"),
    (both(VEC3, "*", three(X), V), "x * v"),
    (both(VEC3, "*", V, three(X)), "v * x"),
    (both(VEC3, "/", V, three(X)), "v / x"),
    (both(VEC3, "/", three(X), V), "vec3(x) / v"),
    (both(VEC3, "+", three(X), V), "vec3(x) + v"),
    (both(VEC3, "-", V, three(X)), "v - vec3(x)"),
    (both(VEC3, "*", X, V), "x * v"),
    (both(VEC3, "*", V, X), "v * x"),
    (both(VEC3, "*", X, three(Y)), "vec3(x * y)"),
    (both(VEC3, "*", three(X, Y, Z), V), "vec3(x, y, z) * v"),
    (both(VEC3, "*", V, three(X, Y, Z)), "v * vec3(x, y, z)"),
    (both(F32, "*", X, Y), "x * y"),
    (ir.Index(F32, ir.Construct(ARRAY, (X, Y, Z)), ir.Const(I32, 1)), "y"),
    (ir.Index(F32, ir.Construct(ARRAY, (X, Y, Z)), K), "f32[3](x, y, z)[k]"),
    (ir.Index(F32, A, ir.Const(I32, 1)), "a[1]"),
    (ir.Construct(ARRAY, (X, X, X)), "f32[3](x, x, x)"),
    (ir.Convert(F32, X), "x"),
    (ir.Convert(I32, N), "i32(n)"),
    (ir.Unary(F32, "negate", X), "-x"),
]


@pytest.mark.parametrize(("e", "left"), LEFT, ids=str)
def test_components_that_are_left(e: ir.Expr, left: str) -> None:
    values = Values(rules=(components,))
    found = values.rebuild(e)
    assert values.show(found) == left
    assert found.type == e.type
    assert {s.name for s in values.log} <= {"scalars"}
    reasons = {s.why.partition(":")[2] for s in values.log}
    alike = {" every component is the same operation on the same operands"}
    assert reasons <= alike | {" components are moved, nothing is computed"}
    assert (reasons & alike != set()) == (isinstance(e, ir.Binary) and bool(reasons))


RANGES = {"x": (1.0, 2.0), "y": (-3.0, 4.0), "z": (8.0, 16.0), "t": (-0.5, -0.25)}
WHOLE = {"n": (3, 9), "k": (-5, 7)}
TRANSFERRED: list[tuple[ir.Expr, list[tuple[float, float]]]] = [
    (both(F32, "+", X, Y), [(-2.0, 6.0)]),
    (both(F32, "-", X, Y), [(-3.0, 5.0)]),
    (both(F32, "-", Y, X), [(-5.0, 3.0)]),
    (ir.Unary(F32, "negate", Y), [(-4.0, 3.0)]),
    (ir.Builtin(F32, "abs", (Y,)), [(0.0, 4.0)]),
    (ir.Builtin(F32, "floor", (T,)), [(-1.0, -1.0)]),
    (ir.Builtin(F32, "min", (X, Y)), [(-3.0, 2.0)]),
    (ir.Builtin(F32, "max", (X, Y)), [(1.0, 4.0)]),
    (ir.Builtin(F32, "clamp", (Y, X, Z)), [(1.0, 4.0)]),
    (ir.Construct(VEC2, (X, Y)), [(1.0, 2.0), (-3.0, 4.0)]),
    (ir.Construct(VEC3, (Y,)), [(-3.0, 4.0)] * 3),
    (ir.Construct(VEC3, (ir.Construct(VEC2, (X, Z)), T)), [(1.0, 2.0), (8.0, 16.0), (-0.5, -0.25)]),
    (part(three(X, Y, Z), "zx"), [(8.0, 16.0), (1.0, 2.0)]),
    (both(VEC2, "+", ir.Construct(VEC2, (X, Y)), ir.Construct(VEC2, (Z, T))), [(9.0, 18.0), (-3.5, 3.75)]),
    (both(VEC2, "*", TWO, ir.Construct(VEC2, (X, Y))), [(2.0, 4.0), (-6.0, 8.0)]),
    (both(VEC2, "*", ir.Construct(VEC2, (X, Y)), TWO), [(2.0, 4.0), (-6.0, 8.0)]),
    (ir.Select(F32, C, X, Z), [(1.0, 16.0)]),
    (ir.Select(F32, both(BOOL, "<", X, Z), X, Z), [(1.0, 2.0)]),
    (ir.Select(F32, both(BOOL, ">", X, Z), X, Z), [(8.0, 16.0)]),
    (ir.Select(VEC2, C, ir.Construct(VEC2, (X, Y)), ir.Construct(VEC2, (Z, T))), [(1.0, 16.0), (-3.0, 4.0)]),
    (ir.Index(F32, ir.Construct(ARRAY, (X, Z, T)), K), [(-0.5, 16.0)]),
    (ir.Index(BOOL, ir.Construct(array_of(BOOL, 2), (both(BOOL, "<", X, Z), C)), K), [(0.0, 1.0)]),
    (ir.Index(BOOL, ir.Construct(array_of(BOOL, 2), (both(BOOL, "<", X, Z),) * 2), K), [(1.0, 1.0)]),
    (ir.Index(I32, ir.Construct(array_of(I32, 2), (K, ir.Const(I32, 40))), K), [(-5.0, 40.0)]),
    (ir.Convert(F32, N), [(3.0, 9.0)]),
    (ir.Convert(F32, K), [(-5.0, 7.0)]),
    (ir.Convert(I32, N), [(3.0, 9.0)]),
    (ir.Convert(U32, ir.Const(I32, -1)), [(2.0**32 - 1.0,) * 2]),
    (ir.Convert(I32, ir.Const(U32, 2**32 - 7)), [(-7.0, -7.0)]),
    (ir.Convert(I32, Y), [(-3.0, 4.0)]),
    (ir.Convert(U32, Z), [(8.0, 16.0)]),
    (ir.Convert(F32, Y), [(-3.0, 4.0)]),
    (both(I32, "+", K, K), [(-10.0, 14.0)]),
    (both(U32, "+", N, ir.Const(U32, 1)), [(4.0, 10.0)]),
    (ir.Construct(UVEC2, (N, ir.Const(U32, 5))), [(3.0, 9.0), (5.0, 5.0)]),
    (both(BOOL, "and", C, both(BOOL, ">", X, Z)), [(0.0, 0.0)]),
    (ir.Unary(BOOL, "not", both(BOOL, ">", X, Z)), [(1.0, 1.0)]),
]


def known() -> Values:
    scalars = {n: ir.Parameter(n, F32, Interval(*ends)) for n, ends in RANGES.items()}
    types = {"n": U32, "k": I32}
    whole = {n: ir.Parameter(n, types[n], Interval(float(a), float(b))) for n, (a, b) in WHOLE.items()}
    return Values(parameters={**scalars, **whole, "c": ir.Parameter("c", BOOL, None)})


@pytest.mark.parametrize(("e", "expected"), TRANSFERRED, ids=str)
def test_range_of_one_operation(e: ir.Expr, expected: Sequence[tuple[float, float]]) -> None:
    values = known()
    assert [(b.low, b.high) for b in Ranges(values).bounds(values.rebuild(e))] == list(expected)


def test_vector_operations_have_a_range_for_each_component() -> None:
    values = known()
    v, w = (values.intern(three(*parts)) for parts in ((X, Y, Z), (Z, X, T)))
    ranges = Ranges(values)
    for op, type_, size in (("cross", VEC3, 3), ("normalize", VEC3, 3), ("dot", F32, 1), ("length", F32, 1)):
        operands = (v, w) if op in ("cross", "dot") else (v,)
        found = ranges.bounds(values.intern(ir.Builtin(type_, op, operands)))
        assert len(found) == size
        assert all(b.low <= b.high for b in found)


def test_elements_with_another_number_are_other_values() -> None:
    values = known()
    array = values.intern(ir.Construct(ARRAY, (X, X, X)))
    one, other = (values.intern(ir.Index(F32, array, ir.Const(I32, k))) for k in (0, 1))
    ranges = Ranges(values)
    (difference,) = ranges.bounds(values.binary("-", one, other))
    assert (difference.low, difference.high) == (-1.0, 1.0)
    (nothing,) = ranges.bounds(values.binary("-", one, one))
    assert (nothing.low, nothing.high) == (0.0, 0.0)


INHERITED = ("/", "sqrt", "inverse_sqrt", "dot", "length")


def said(name: str, operation: str) -> object:
    """What a table says of an operation, and of what others inherit from."""
    table = load_table(name)
    rows = [table.row(op) if op in table.rows else None for op in (operation, *INHERITED)]
    told = [None if r is None else (r.accuracy, r.magnitude, r.reciprocal, r.zero, r.normal) for r in rows]
    return table.rounding, table.flush, table.fused, told


@pytest.mark.parametrize("operation", ["+", "/", "sqrt", "length", "sin", "exp", "min", "negate", "atan2"])
def test_tables_share_a_signature_if_they_say_the_same(operation: str) -> None:
    e = ir.Builtin(F32, operation, (X,)) if operation.isalpha() else ir.Binary(F32, operation, X, Y)
    found = transfer.signatures(e)
    assert len(found) == len(TABLES) == len(transfer.transfers())
    assert found == tuple(t.signature(e) for t in transfer.transfers())
    for (one, a), (other, b) in itertools.combinations(zip(TABLES, found, strict=True), 2):
        assert (a == b) == (said(one, operation) == said(other, operation))


ANY_OPERATION: list[tuple[ir.Binary | ir.Builtin, tuple[tuple[float, float], ...]]] = [
    *((ir.Binary(F32, op, X, Y), ((1.0, 3.0), (2.0, 5.0))) for op in "+-*/"),
    *((ir.Builtin(F32, op, (X,)), ((1.0, 3.0),)) for op in ("sqrt", "inverse_sqrt", "exp2", "log", "sin")),
    *((ir.Builtin(F32, op, (X, Y)), ((1.0, 3.0), (2.0, 5.0))) for op in ("atan2", "max")),
    (ir.Builtin(F32, "dot", (V, W)), ((1.0, 3.0), (2.0, 5.0))),
    (ir.Builtin(VEC3, "cross", (V, W)), ((1.0, 3.0), (2.0, 5.0))),
    (ir.Builtin(F32, "length", (V,)), ((1.0, 3.0),)),
    (ir.Builtin(VEC3, "normalize", (V,)), ((1.0, 3.0),)),
]
"""Operations, and the range of each operand's components."""


@pytest.mark.parametrize("row", ["+", *INHERITED, "exp2", "cross"])
def test_tables_that_give_other_ranges_share_no_signature(row: str, monkeypatch: pytest.MonkeyPatch) -> None:
    usual = load_table("wgsl")
    looser = replace(usual.row(row), accuracy=Scaled(1000.0) if row in ("dot", "cross") else Ulp(1000.0))
    changed = replace(usual, name=f"looser {row}", rows={**usual.rows, row: looser})
    tables = {t.name: t for t in (usual, changed)}
    monkeypatch.setattr(transfer, "load_table", tables.__getitem__)
    one, other = (transfer.Transfer(name) for name in tables)
    for e, ends in ANY_OPERATION:
        size = 3 if e.op in VECTOR_BUILTINS else 1
        operands = tuple(tuple(Range(np.array([a]), np.array([b])) for _ in range(size)) for a, b in ends)
        tight, loose = (ends_of(t.computed(e, operands)) for t in (one, other))
        assert tight == loose or one.signature(e) != other.signature(e)


def ends_of(found: Sequence[object]) -> list[tuple[float, float]]:
    return [(float(s.low[0]), float(s.high[0])) for s in found if isinstance(s, Range)]


def test_what_is_remembered_is_made_once_and_not_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(transfer, "_memory", {})
    monkeypatch.setattr(transfer, "MOST_REMEMBERED", 2)
    calls: list[int] = []

    def make(k: int) -> transfer.Bound:
        calls.append(k)
        return ()

    for k in (1, 1, 2, 3, 1):
        assert transfer.remembered(k, partial(make, k)) == ()
    assert calls == [1, 2, 3]
    transfer.remembered(4, partial(make, 4), "kept alive")
    assert transfer._memory == {4: ((), "kept alive")}
