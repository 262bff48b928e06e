"""Small flows of branches and loops, built by hand over a few parameters."""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, VEC3, Field, Struct, array_of
from codegen.passes.ssa.flow import Branch, Carried, Item, Loop, Merge
from codegen.passes.ssa.values import Values

PAIR = Struct("Pair", (Field("first", F32), Field("second", F32)))
ARRAY = array_of(F32, 2)
X, Y, Z, P = ir.Var(F32, "x"), ir.Var(F32, "y"), ir.Var(F32, "z"), ir.Var(BOOL, "p")
V, W, A, S, N = ir.Var(VEC3, "v"), ir.Var(VEC3, "w"), ir.Var(ARRAY, "a"), ir.Var(PAIR, "s"), ir.Var(I32, "n")
ONE, TWO = ir.Const(F32, 1.0), ir.Const(I32, 2)
PARAMETERS = {name: name for name in "xyzvwpasn"}


def made() -> Values:
    values = Values(function="f", line=1)
    values.parameters = {e.name: ir.Parameter(e.name, e.type, None) for e in (X, Y, Z, V, W, P, A, S, N)}
    for e in (X, Y, Z, V, W, P, A, S, N):
        values.intern(e)
    return values


def plus(values: Values, *parts: ir.Expr) -> ir.Expr:
    """A sum from the left: one operation fewer than parts."""
    total = parts[0]
    for part in parts[1:]:
        total = values.binary("+", total, part)
    return total


def chain(values: Values, of: ir.Expr, count: int) -> ir.Expr:
    """So many operations, one on the other."""
    for k in range(count):
        of = values.binary("-" if k % 2 else "*", of, (Y, Z, X)[k % 3])
    return of


def root_of(values: Values, e: ir.Expr) -> ir.Expr:
    return values.build(ir.Builtin(F32, "sqrt", (e,)))


def leaf(values: Values, name: str) -> ir.Var:
    e = values.intern(ir.Var(F32, name))
    assert isinstance(e, ir.Var)
    return e


Row = tuple[str, ir.Expr, ir.Expr]


def loop(
    values: Values, name: str, body: list[Item], carried: list[Row], limit: ir.Expr | None = None
) -> Loop:
    """A loop of 3 iterations, or of up to 5; carried: name, first value, following value."""
    index = values.intern(ir.Var(I32, f"{name}@"))
    assert isinstance(index, ir.Var)
    rows = [
        Carried(leaf(values, f"{c}@in"), leaf(values, f"{c}@out"), c, start, following)
        for c, start, following in carried
    ]
    return Loop(index, name, 2 if limit is None else 0, 5, limit, body, rows)


def branch(
    values: Values,
    condition: ir.Expr,
    merges: list[Row],
    then: list[Item] | None = None,
    orelse: list[Item] | None = None,
) -> Branch:
    rows = [Merge(leaf(values, f"{name}@merged"), name, a, b) for name, a, b in merges]
    return Branch(condition, then or [], orelse or [], rows)
