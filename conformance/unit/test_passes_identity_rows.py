"""Identities, transcribed by hand: what each row makes of an example, and what it leaves alone.

Plan. x y z are floats, v w vectors, u a unit vector, p q truth values, m n u32, k i32; r is at least 0.5.
  made       one example of every row, in another order of operands where that is the same
  kinds      a row takes part only where its kind is asked for; the log tells row, kind and note
  left       examples that look like a row and are none
  conditions each condition, on both sides of its limit
"""

from __future__ import annotations

import pytest

from codegen.ir import nodes as ir
from codegen.ir.domains import Finite, Interval, Unit
from codegen.ir.types import BOOL, F32, I32, U32, VEC3, Type
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.rules.identities import CONDITIONS, ROWS, identities
from codegen.passes.rules.scalars import components
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Values

KINDS = frozenset({"exact", "finite", "real", "unit"})
NAMES: dict[str, Type] = {
    **dict.fromkeys("xyzr", F32), **dict.fromkeys("vwu", VEC3), **dict.fromkeys("pq", BOOL),
    **dict.fromkeys("mn", U32), "k": I32,
}  # fmt: skip


def made(text: str, type_: Type, kinds: frozenset[str] = KINDS) -> tuple[str, list[str]]:
    """What is left of an expression, and the reasons that are told, of the identities alone."""
    values = Values()
    for name, kind in NAMES.items():
        domain = Unit() if name == "u" else Interval(0.5, 9.0) if name == "r" else Finite()
        values.parameters = {**values.parameters, name: ir.Parameter(name, kind, domain)}
    values.simplify_by((components, identities(Ranges(values), kinds)))
    found: dict[str, ir.Expr] = {name: values.intern(ir.Var(kind, name)) for name, kind in NAMES.items()}
    e = patterns.make(patterns.parse(text), found, values, type_)
    return values.show(e), [s.why for s in values.log if s.name == "identities"]


MADE: dict[Type, dict[str, tuple[str, str]]] = {
    F32: {
        "x + 0.0": ("x", "exact"), "0.0 + x": ("x", "exact"), "x - 0.0": ("x", "exact"),
        "0.0 - x": ("-x", "exact"), "x - x": ("0", "finite"), "x + -y": ("x - y", "exact"),
        "-y + x": ("x - y", "exact"), "x - -y": ("x + y", "exact"), "-(-x)": ("x", "exact"),
        "-(x - y)": ("y - x", "exact"), "x * 0.0": ("0", "finite"), "x * 1.0": ("x", "exact"),
        "1.0 * x": ("x", "exact"), "x * -1.0": ("-x", "exact"), "-x * -y": ("x * y", "exact"),
        "x / 1.0": ("x", "exact"), "0.0 / x": ("0", "finite"), "r / r": ("1", "finite"),
        "x / 4.0": ("x * (1 / 4)", "exact"), "4.0 * (0.3 * x)": ("(4 * 0.3) * x", "exact"),
        "4.0 * (x * 0.3)": ("(4 * 0.3) * x", "exact"), "(0.3 * x) * 4.0": ("(4 * 0.3) * x", "exact"),
        "2.0 * (x + x)": ("(2 + 2) * x", "exact"),
        "min(x, x)": ("x", "exact"), "max(x, x)": ("x", "exact"), "min(x, max(x, y))": ("x", "exact"),
        "min(max(y, x), x)": ("x", "exact"), "max(x, min(x, y))": ("x", "exact"),
        "min(x, min(x, y))": ("min(x, y)", "exact"), "max(x, max(x, y))": ("max(x, y)", "exact"),
        "min(0.5, min(0.25, x))": ("min(min(0.5, 0.25), x)", "exact"),
        "max(0.5, max(0.25, x))": ("max(max(0.5, 0.25), x)", "exact"),
        "abs(abs(x))": ("abs(x)", "exact"), "abs(-x)": ("abs(x)", "exact"), "abs(x * x)": ("x * x", "exact"),
        "sqrt(x * x)": ("abs(x)", "real"), "sqrt(x) * sqrt(x)": ("x", "real"),
        "floor(floor(x))": ("floor(x)", "exact"),
        "dot(v, 0.0 * v)": ("0", "finite"), "dot(u, u)": ("1", "unit"), "length(u)": ("1", "unit"),
        "x if p else x": ("x", "exact"), "x if not p else y": ("y if p else x", "exact"),
        "(x if p else y) if p else z": ("x if p else z", "exact"),
        "x if p else (y if p else z)": ("x if p else z", "exact"),
    },
    VEC3: {
        "v + 0.0": ("v", "exact"), "v - v": ("vec3(0)", "finite"), "cross(v, v)": ("vec3(0)", "finite"),
        "cross(v, -v)": ("vec3(0)", "finite"), "cross(-v, v)": ("vec3(0)", "finite"),
        "cross(v, 0.0 * v)": ("vec3(0)", "finite"), "cross(0.0 * v, v)": ("vec3(0)", "finite"),
        "normalize(u)": ("u", "unit"), "-(v - w)": ("w - v", "exact"), "v if p else v": ("v", "exact"),
        "v if not p else w": ("w if p else v", "exact"), "v * 1.0": ("v", "exact"),
    },
    BOOL: {
        "True if p else False": ("p", "exact"), "False if p else True": ("not p", "exact"),
        "not (not p)": ("p", "exact"), "p and p": ("p", "exact"), "p or p": ("p", "exact"),
        "p and True": ("p", "exact"), "p and False": ("false", "exact"), "True or p": ("true", "exact"),
        "p or False": ("p", "exact"), "not (x < y)": ("x >= y", "finite"),
        "not (x <= y)": ("x > y", "finite"), "not (x > y)": ("x <= y", "finite"),
        "not (x >= y)": ("x < y", "finite"), "not (m == n)": ("m != n", "exact"),
        "not (m != n)": ("m == n", "exact"), "x < x": ("false", "exact"), "x > x": ("false", "exact"),
        "x <= x": ("true", "finite"), "x >= x": ("true", "finite"), "x == x": ("true", "finite"),
        "x != x": ("false", "finite"), "min(x, 0.5) < 0.25": ("x < 0.25", "exact"),
        "min(x, 0.5) <= 0.25": ("x <= 0.25", "exact"), "max(x, 0.25) > 0.5": ("x > 0.5", "exact"),
        "max(x, 0.25) >= 0.5": ("x >= 0.5", "exact"),
    },
    U32: {
        "n + 0": ("n", "exact"), "n - n": ("0", "finite"), "n * 0": ("0", "finite"), "n * 1": ("n", "exact"),
        "n // 1": ("n", "exact"), "n % 1": ("0", "exact"), "n << 0": ("n", "exact"),
        "n >> 0": ("n", "exact"), "n & n": ("n", "exact"), "n & 0": ("0", "exact"), "n | n": ("n", "exact"),
        "0 | n": ("n", "exact"), "n ^ n": ("0", "exact"), "n ^ 0": ("n", "exact"), "~(~n)": ("n", "exact"),
        "m if not p else n": ("n if p else m", "exact"),
    },
    I32: {"0 - k": ("-k", "exact"), "-(-k)": ("k", "exact")},
}  # fmt: skip
EXAMPLES = [(type_, text) for type_, rows in MADE.items() for text in rows]


@pytest.mark.parametrize(("type_", "text"), EXAMPLES, ids=str)
def test_what_a_row_makes_and_of_which_kind_it_is(type_: Type, text: str) -> None:
    left, kind = MADE[type_][text]
    found, reasons = made(text, type_)
    assert found == left
    told = reasons[-1]
    row = next(r for r in ROWS if told == f"{r.pattern} = {r.replacement}, {r.kind}: {r.note}")
    assert row.kind == kind
    unasked = made(text, type_, KINDS - {kind})
    assert told not in unasked[1]


def test_every_row_has_an_example() -> None:
    told = {reason for type_, text in EXAMPLES for reason in made(text, type_)[1]}
    missing = [r.pattern for r in ROWS if f"{r.pattern} = {r.replacement}, {r.kind}: {r.note}" not in told]
    assert not missing
    assert len(ROWS) == 81


LEFT: dict[Type, tuple[str, ...]] = {
    F32: (
        *("x + y", "x + 1.0", "x - y", "1.0 - x", "x - 1.0", "-(x + y)", "x * y", "x * 2.0", "x * -2.0"),
        *("x / 3.0", "x / 2.5", "x / x", "x / y", "1.0 / x", "3.0 * (0.3 * x)", "4.0 * (y * x)"),
        *("3.0 * (x + x)", "2.0 * (x + y)", "min(x, y)", "min(x, min(y, z))", "max(x, max(y, z))"),
        *("min(x, max(y, z))", "min(0.5, min(y, x))", "max(y, max(0.25, x))", "abs(x * y)", "sqrt(x * y)"),
        *("sqrt(x) * sqrt(y)", "abs(x)", "dot(v, v)", "dot(u, v)", "length(v)", "x if p else y"),
        *("(x if q else y) if p else z", "x if p else (y if q else z)", "-x", "-x * y", "0.3 / 4.0"),
    ),
    VEC3: ("cross(v, w)", "cross(v, -w)", "normalize(v)", "normalize(u + v)"),
    BOOL: (
        *("p and q", "p or q", "not p", "x < y", "min(x, 0.25) < 0.5", "min(x, 0.5) < 0.5"),
        *("min(x, 0.25) <= 0.5", "max(x, 0.5) > 0.25", "max(x, 0.5) >= 0.25", "max(x, 0.5) >= 0.5"),
        *("min(x, 0.5) <= 0.5", "max(x, 0.5) > 0.5", "min(x, y) < 0.25"),
    ),
    U32: ("0 - n", "n // 2", "n % 2", "n << 1", "n >> 1", "n & m", "n | 1", "n ^ m", "~n", "4 * (3 * n)"),
}


@pytest.mark.parametrize(("type_", "text"), [(t, x) for t, rows in LEFT.items() for x in rows], ids=str)
def test_what_no_row_speaks_of_is_left(type_: Type, text: str) -> None:
    assert made(text, type_)[1] == []


def holds(condition: str, *operands: ir.Expr) -> bool:
    values = Values()
    values.parameters = {
        **{n: ir.Parameter(n, F32, Interval(*e)) for n, e in ENDS.items()},
        "u": ir.Parameter("u", VEC3, Unit()),
    }
    return CONDITIONS[condition](values, Ranges(values), *map(values.rebuild, operands))


ENDS = {"a": (0.5, 2.0), "b": (-2.0, -0.5), "c": (0.0, 1.0), "d": (-1.0, 0.0), "e": (-1.0, 1.0)}


def constant(*numbers: float | int | bool, type_: Type = F32) -> ir.Expr:
    if len(numbers) == 1:
        return ir.Const(type_, numbers[0])
    return ir.Construct(VEC3, tuple(ir.Const(F32, x) for x in numbers))


def variable(name: str, type_: Type = F32) -> ir.Expr:
    return ir.Var(type_, name)


def vector(*names: str) -> ir.Expr:
    return ir.Construct(VEC3, tuple(map(variable, names)))


CASES: list[tuple[str, tuple[ir.Expr, ...], bool]] = [
    *(("power_of_two", (constant(x),), True) for x in (1.0, 2.0, -4.0, 0.25, -0.5)),
    *(("power_of_two", (constant(x),), False) for x in (0.0, 3.0, -3.0, 0.75)),
    ("power_of_two", (constant(4, type_=U32),), False),
    ("power_of_two", (variable("a"),), False),
    ("power_of_two", (constant(1.0, 2.0, 4.0),), True),
    ("power_of_two", (constant(1.0, 2.0, 3.0),), False),
    ("constant", (constant(3.0),), True),
    ("constant", (constant(1.0, 2.0, 3.0),), True),
    ("constant", (variable("a"),), False),
    ("varies", (constant(3.0),), False),
    ("varies", (variable("a"),), True),
    *(("signed", (variable("s", t),), signed) for t, signed in ((F32, True), (VEC3, True), (I32, True))),
    *(("signed", (variable("s", t),), signed) for t, signed in ((U32, False), (BOOL, False))),
    ("unit", (variable("u", VEC3),), True),
    ("unit", (variable("w", VEC3),), False),
    *(("nonzero", (variable(name),), name in "ab") for name in ENDS),
    ("nonzero", (vector("a", "b", "a"),), True),
    ("nonzero", (vector("a", "c", "b"),), False),
    ("nonzero", (vector("d", "a", "b"),), False),
    ("above", (constant(2.0), constant(1.0)), True),
    ("above", (constant(1.0), constant(2.0)), False),
    ("above", (constant(1.0), constant(1.0)), False),
    ("above", (variable("a"), constant(-9.0)), False),
    ("above", (constant(9.0), variable("a")), False),
]


@pytest.mark.parametrize(("condition", "operands", "expected"), CASES, ids=str)
def test_conditions(condition: str, operands: tuple[ir.Expr, ...], expected: bool) -> None:
    assert holds(condition, *operands) == expected


def test_every_condition_has_a_case() -> None:
    assert {name for name, _, _ in CASES} == set(CONDITIONS)
    used = {condition.split()[0] for row in ROWS for condition in row.when}
    assert used == set(CONDITIONS)
