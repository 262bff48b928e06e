"""Every row of the table of identities is as sound as it says.

Plan. Each row becomes two functions of one library, its pattern and its replacement, over random operands of
the types that the names stand for (constants that meet its conditions; unit vectors where it asks for them).
  exact, finite   under every table, what the replacement computes in float32 is a permitted result of the
                  pattern
  real            the same under the tables that take either neighbour, and in float64 both agree
  unit            the difference is within the length that a unit vector may miss
And each row is found: the pass turns the pattern into the replacement.
"""

from __future__ import annotations

import re

import numpy as np
import pytest

from codegen.errors import Place
from codegen.evaluate import evaluate
from codegen.intervals import TABLES, load_table, permitted
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Finite, Interval, Unit
from codegen.ir.types import BOOL, F32, U32, VEC3, Type
from codegen.ir.verify import verify
from codegen.library import load_library
from codegen.passes.analysis.norms import UNIT_SLACK
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.rules.identities import ROWS, Row, identities
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Values
from conformance.unit.support.tolerances import tolerance
from conformance.unit.support.trees import no_function

LANES = 400
SEED = 20261122
TYPES: dict[str, Type] = {
    **dict.fromkeys("xyz", F32), **dict.fromkeys("ab", F32), **dict.fromkeys("uvw", VEC3),
    **dict.fromkeys("pq", BOOL), **dict.fromkeys("mn", U32),
}  # fmt: skip
CONSTANTS = {"a": 4.0, "b": float(np.float32(0.3))}
"""Both conditions at once: a is a power of two and above b."""
POSITIVE = ("sqrt", "nonzero")
EITHER = [name for name in TABLES if load_table(name).rounding == "either"]


def row_id(row: Row) -> str:
    return f"{row.pattern} = {row.replacement}"


def names_of(row: Row) -> list[str]:
    return sorted(patterns.names(patterns.parse(row.pattern)))


def domain_of(row: Row, name: str) -> Domain | None:
    if f"unit {name}" in row.when:
        return Unit()
    if any(word in row.pattern or word in " ".join(row.when) for word in POSITIVE):
        return Interval(1e-3, 1e3)
    return Finite() if TYPES[name] in (F32, VEC3) else None


def type_of_result(row: Row) -> Type:
    pattern = patterns.parse(row.pattern)
    assert isinstance(pattern, patterns.Operation)
    op = pattern.op
    if op in ("cross", "normalize"):
        return VEC3
    if op in ("not", "and", "or", "<", "<=", ">", ">=", "==", "!="):
        return BOOL
    if op in ("dot", "length"):
        return F32
    names = [n for n in names_of(row) if n in "xyz"] or names_of(row)
    if op == "select" and not any(n in "xyz" for n in names):
        return BOOL
    return TYPES[names[0]]


def function_of(row: Row, text: str, values: Values) -> ir.Function:
    """The pattern or replacement as it stands, or as the rules of `values` leave it."""
    parameters = tuple(ir.Parameter(n, TYPES[n], domain_of(row, n)) for n in names_of(row) if n not in "ab")
    values.parameters = {p.name: p for p in parameters}
    found = {p.name: values.intern(ir.Var(p.type, p.name)) for p in parameters}
    found |= {n: values.number(CONSTANTS[n], F32) for n in names_of(row) if n in "ab"}
    result = patterns.make(patterns.parse(text), found, values, type_of_result(row))
    name = "probe"
    return ir.Function(
        name, "", "base", None, parameters, result.type, (ir.Return(result),), ir.Doc("", {}), Place("", 1)
    )


def inputs_of(row: Row) -> dict[str, np.ndarray]:
    random = np.random.default_rng(SEED)
    made = {}
    for name in names_of(row):
        if name in "ab":
            continue
        shape = (LANES, 3) if TYPES[name] == VEC3 else (LANES,)
        if TYPES[name] == BOOL:
            made[name] = random.integers(0, 2, shape) == 1
        elif TYPES[name] == U32:
            made[name] = random.integers(0, 2**32, shape, dtype=np.uint32)
        else:
            size = np.exp(random.uniform(-6.0, 6.0, shape))
            signs = 1.0 if isinstance(domain_of(row, name), Interval) else random.choice([-1.0, 1.0], shape)
            a = size * signs
            if isinstance(domain_of(row, name), Unit):
                a = a / np.linalg.norm(a, axis=-1, keepdims=True)
            made[name] = a.astype(np.float32)
    return made


@pytest.mark.parametrize("row", ROWS, ids=row_id)
def test_row_says_what_it_is(row: Row) -> None:
    """A kind that the pass knows, and a note in plain words: neither is taken for the other."""
    assert row.kind in ("exact", "finite", "real", "unit")
    assert row.note != row.kind and re.fullmatch(r"[A-Za-z0-9 ,;^'()*/+-]+", row.note)


OPERATIONS = (
    "+",
    "-",
    "*",
    "/",
    "//",
    "%",
    "<<",
    ">>",
    "&",
    "|",
    "^",
    "<",
    "<=",
    ">",
    ">=",
    "==",
    "!=",
    "and",
    "or",
)


@pytest.mark.parametrize("text", [*(f"x {op} y" for op in OPERATIONS), "min(x, y)", "y if x else z"])
def test_operands_of_a_pattern_come_as_they_are_written(text: str) -> None:
    """The condition of a choice first, as the IR has it."""
    found = patterns.parse(text)
    assert isinstance(found, patterns.Operation)
    assert found.operands[:2] == (patterns.Name("x"), patterns.Name("y"))


@pytest.mark.parametrize("row", ROWS, ids=row_id)
def test_replacement_is_a_permitted_result_of_the_pattern(row: Row) -> None:
    library = load_library()
    before = function_of(row, row.pattern, Values())
    after = function_of(row, row.replacement, Values())
    verify(before, no_function)
    verify(after, no_function)
    inputs = inputs_of(row)
    kept = {p.name: inputs[p.name] for p in after.parameters}
    got = evaluate(library.with_functions([after]), "probe", kept, "float32")
    assert isinstance(got, np.ndarray)
    general = library.with_functions([before])
    if row.kind == "unit":
        exact = evaluate(general, "probe", inputs, "float64")
        assert np.abs(got - exact).max() <= UNIT_SLACK
        return
    for table in EITHER if row.kind == "real" else TABLES:
        allowed = permitted(general, "probe", inputs, table)
        assert allowed.guaranteed.any()
        assert allowed.contains(got).all(), table
    if row.kind == "real":
        exact = evaluate(general, "probe", inputs, "float64")
        same = evaluate(library.with_functions([after]), "probe", kept, "float64")
        assert isinstance(exact, np.ndarray)
        assert isinstance(same, np.ndarray)
        np.testing.assert_allclose(same, exact, rtol=tolerance("eight_ulp"))


@pytest.mark.parametrize("row", ROWS, ids=row_id)
def test_row_is_found(row: Row) -> None:
    values = Values()
    values.simplify_by((identities(Ranges(values), frozenset({row.kind})),))
    made = function_of(row, row.pattern, values)
    wanted = function_of(row, row.replacement, values)
    assert made.body == wanted.body
    assert values.log


def test_every_condition_is_used_and_every_note_says_why() -> None:
    assert all(row.note and row.kind in ("exact", "finite", "real", "unit") for row in ROWS)
    assert len({row.pattern for row in ROWS}) == len(ROWS)
