"""Every row of the op registry is complete and true.

Plan.
  completeness  a citation, a known cost class, probes; built-ins have a summary and one parameter name per
                argument (what is promised for each row stands in codegen/intervals/tables)
  spelling      one function per overload, all in one module, is accepted by every dialect's compiler
  meaning       at its probes each row gives finite values, and numpy in float64 agrees with mpmath to the
                rounding of float64
  stub          shaderlib/lang.py is what the registry generates
"""

from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from codegen.backends import TARGETS
from codegen.emit.dialect import Dialect
from codegen.emit.stmt import StmtPrinter
from codegen.errors import Place
from codegen.evaluate.arrays import arithmetic
from codegen.ir import nodes as ir
from codegen.ir.types import F32, TEXTURE, Scalar, Type, Vector
from codegen.ir.verify import verify
from codegen.ops import BUILTINS, OPERATORS, Op
from codegen.ops.op import COSTS, table
from codegen.ops.stub import generate
from conformance.unit.support.dialects import DIALECTS, dialect_id, validate
from conformance.unit.support.trees import no_function

ROWS = [
    row
    for row in (*OPERATORS.values(), *BUILTINS.values())
    if all(TEXTURE not in types for types, _ in row.rule)
]
"""Rows over numbers; those over maps have tests of their own."""
NOWHERE = Place("test", 1)
DOUBLE_ROUNDINGS = 8 * 2.0**-52
"""What float64 may differ from mpmath, relative: a row is a few operations of half an ULP each."""


def row_id(row: Op) -> str:
    return row.name


@pytest.mark.parametrize("row", ROWS, ids=row_id)
def test_row_is_complete(row: Op) -> None:
    assert any(character.isdigit() for character in row.see), "cite the section of a specification"
    assert row.cost in COSTS
    assert row.rule
    assert len({types for types, _ in row.rule}) == len(row.rule)
    assert row.probe
    assert set(row.spell) <= set(TARGETS)


@pytest.mark.parametrize("row", BUILTINS.values(), ids=row_id)
def test_built_in_is_described(row: Op) -> None:
    assert row.summary.endswith(".")
    assert {len(types) for types, _ in row.rule} == {len(row.names)}
    assert len(set(row.names)) == len(row.names)
    assert all(name.isidentifier() and name.strip("_") == name for name in row.names)


OPERANDS = {
    **{name: "a b" for name in ("dot", "cross")},
    **{name: "x y" for name in ("min", "max")},
    "clamp": "x low high",
    "atan2": "y x",
    "lookup": "t uv",
    "lookup_level": "t uv lod",
}
"""What the operands of built-ins with several are called, in their order."""


def test_operands_have_their_usual_names() -> None:
    assert {name: " ".join(op.names) for name, op in BUILTINS.items() if len(op.names) > 1} == OPERANDS


def test_a_row_given_twice_is_refused() -> None:
    with pytest.raises(ValueError, match="rows given twice: sqrt"):
        table(BUILTINS["sqrt"], BUILTINS["sqrt"])


def overloads() -> list[tuple[Op, tuple[Type, ...], Type]]:
    return [(row, types, result) for row in ROWS for types, result in row.rule]


def one_line_function(name: str, row: Op, types: tuple[Type, ...], result: Type) -> ir.Function:
    """A function that returns the operation applied to its parameters."""
    parameters = tuple(ir.Parameter(f"operand_{k}", t, None) for k, t in enumerate(types))
    args = tuple(ir.Var(p.type, p.name) for p in parameters)
    if row.name in BUILTINS:
        value: ir.Expr = ir.Builtin(result, row.name, args)
    elif len(args) == 1:
        value = ir.Unary(result, row.name, args[0])
    else:
        value = ir.Binary(result, row.name, args[0], args[1])
    return ir.Function(
        name, "", "base", None, parameters, result, (ir.Return(value),), ir.Doc("", {}), NOWHERE
    )


@pytest.mark.parametrize("dialect", DIALECTS, ids=dialect_id)
def test_every_overload_compiles(dialect: Dialect) -> None:
    printer = StmtPrinter(dialect)
    lines: list[str] = []
    for k, (row, types, result) in enumerate(overloads()):
        function = one_line_function(f"overload_{k}", row, types, result)
        verify(function, no_function)
        lines += printer.function(function)
    validate("\n".join(lines) + "\n", dialect)


def is_float(type_: Type) -> bool:
    return type_ == F32 or (isinstance(type_, Vector) and type_.element == F32)


def fitting_rule(row: Op, probe: tuple[Any, ...]) -> tuple[tuple[Type, ...], Type]:
    """The overload that a probe speaks of: by sizes, and whole numbers only where an integer is meant."""
    for types, result in row.rule:
        sizes = tuple(t.size if isinstance(t, Vector) else 0 for t in types)
        floats = tuple(is_float(t) for t in types)
        given = tuple(np.shape(v)[0] if np.ndim(v) else 0 for v in probe)
        kinds = tuple(np.asarray(v).dtype.kind == "f" for v in probe)
        if sizes == given and floats == kinds:
            return types, result
    raise AssertionError(f"{row.name}: no overload takes the probe {probe}")


def lanes(type_: Type, value: Any, *, precise: bool) -> Any:
    """A probe's operand as an array of one lane, scalars (1,) and vectors (1, size)."""
    element = type_.element if isinstance(type_, Vector) else type_
    assert isinstance(element, Scalar)
    if element == F32:
        exact = np.asarray(np.float32(value), np.float64)
        found = np.vectorize(mpmath.mpf, otypes=[object])(exact) if precise else exact
    else:
        found = np.asarray(value, {"i32": np.int32, "u32": np.uint32, "bool": np.bool_}[element.name])
    return np.asarray(found)[None]


@pytest.mark.parametrize(
    ("row", "probe"),
    [(row, probe) for row in ROWS for probe in row.probe],
    ids=lambda v: getattr(v, "name", None),
)
def test_numpy_means_what_mpmath_means(row: Op, probe: tuple[Any, ...]) -> None:
    types, result = fitting_rule(row, probe)
    double, precise = arithmetic("float64"), arithmetic("mpmath")
    with mpmath.workdps(40):
        got = row.meaning(
            double.namespace, *(lanes(t, v, precise=False) for t, v in zip(types, probe, strict=True))
        )
        expected = row.meaning(
            precise.namespace, *(lanes(t, v, precise=True) for t, v in zip(types, probe, strict=True))
        )
    exact = np.asarray(expected).astype(np.float64)
    assert np.asarray(got).shape == exact.shape
    assert np.all(np.isfinite(exact))
    if is_float(result):
        assert np.all(np.abs(got - exact) <= DOUBLE_ROUNDINGS * np.abs(exact))
    else:
        assert np.array_equal(np.asarray(got).astype(np.float64), exact)


def test_language_stub_is_up_to_date() -> None:
    path = Path(__file__).parents[2] / "shaderlib" / "lang.py"
    assert path.read_text(encoding="utf-8") == generate(), "run ./dev gen"
