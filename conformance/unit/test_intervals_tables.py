"""Accuracy tables are complete, cite their clauses, and are refused with one sentence where they are wrong.

Plan.
  completeness  one row per operation of the registry and one for casts, each citing a clause; silent
                specifications are marked as assumed
  shape         promises named by the specifications stand in the tables: division, exponentials, trigonometry
  refusals      unknown and missing rows and keys, bad kinds, ranges and formulas
"""

from __future__ import annotations

import pytest

from codegen.errors import UserError
from codegen.intervals import TABLES, load_table
from codegen.intervals.accuracy import Absolute, Exact, Inherited, Rounded, Ulp
from codegen.intervals.tables import CAST, FOLDER, FORMULAS, read_table
from codegen.ops import BUILTINS, OPERATORS

CITED = ("WGSL", "Vulkan", "SPIR-V", "GLSL", "OpenCL C")
LOOKUPS = {"lookup", "lookup_level"}
SILENT = {
    "wgsl": LOOKUPS,
    "glsl": {"sin", "cos", "atan2", "normalize"} | LOOKUPS,
    "glsl_es": {"sin", "cos", "atan2", "normalize"} | LOOKUPS,
    "opencl": LOOKUPS,
    "opencl_relaxed": {"/", "atan2"} | LOOKUPS,
}


@pytest.mark.parametrize("name", TABLES)
def test_every_operation_has_a_row_that_cites_a_clause(name: str) -> None:
    table = load_table(name)
    assert set(table.rows) == {*OPERATORS, *BUILTINS, CAST}
    for operation, row in table.rows.items():
        assert row.cite.startswith(CITED), f"{operation}: {row.cite}"
    for why in table.settings.values():
        assert len(why) > len("a clause")


@pytest.mark.parametrize("name", TABLES)
def test_only_silent_specifications_are_assumed(name: str) -> None:
    assumed = {operation for operation, row in load_table(name).rows.items() if row.assumed}
    assert assumed == SILENT.get(name, set())


@pytest.mark.parametrize("name", TABLES)
def test_promises_of_the_specifications(name: str) -> None:
    table = load_table(name)
    relaxed, full = name == "opencl_relaxed", name == "opencl"
    for operation in ("+", "-", "*"):
        assert table.row(operation).accuracy == Rounded()
    for operation in ("<", "and", "&", "abs", "min", "clamp", "floor", "negate"):
        assert table.row(operation).accuracy == Exact()
    assert table.row("/").accuracy == Ulp(2.5)
    assert table.row("inverse_sqrt").accuracy == Ulp(2.0)
    exponential = Ulp(3.0) if full else Ulp(3.0, 2.0, whole=relaxed)
    logarithm = Ulp(3.0) if full else Absolute(2.0**-21, (0.5, 2.0), Ulp(3.0))
    assert table.row("exp").accuracy == table.row("exp2").accuracy == exponential
    assert table.row("log").accuracy == table.row("log2").accuracy == logarithm
    root = table.row("sqrt").accuracy
    assert root == (Ulp(3.0) if name.startswith("opencl") else Inherited(FORMULAS[0]))
    assert table.rounding == ("nearest" if name.startswith("opencl") else "either")


BROKEN = {
    "unknown operation": (
        "[operations.sqrt]",
        "[operations.sqrrt]",
        'unknown operation "sqrrt"; did you mean "sqrt"',
    ),
    "missing operation": ("[operations.floor]", "[operations.ceil]", 'unknown operation "ceil"'),
    "unknown kind": ('kind = "rounded"', 'kind = "rounde"', 'unknown kind "rounde"; did you mean "rounded"'),
    "unknown key": ("ulps = 2.5", "ulps = 2.5\nulp = 1", 'unknown key "ulp"'),
    "missing key": ("ulps = 2.5\n", "", "lacks ulps"),
    "negative bound": ("ulps = 2.5", "ulps = -2.5", "ulps is a number above 0, not -2.5"),
    "no citation": (
        'cite = "WGSL 15.7.4',
        'cites = "WGSL 15.7.4',
        'unknown key "cites"; did you mean "cite"',
    ),
    "empty sentence": ("ulps = 2.5\n", 'ulps = 2.5\nassumed = " "\n', "assumed is a sentence"),
    "number for a sentence": ("ulps = 2.5\n", "ulps = 2.5\nassumed = 5\n", "assumed is a sentence"),
    "unknown operand": ("{ y = [-126, 126] }", "{ z = [-126, 126] }", 'no operand "z"'),
    "reversed range": ("{ y = [-126, 126] }", "{ y = [126, -126] }", "two numbers in ascending order"),
    "unknown formula": (
        'formula = "1 / inverse_sqrt(x)"',
        'formula = "sqrt(x)"',
        'unknown formula "sqrt(x)"',
    ),
    "rounding": ('rounding = "either"', 'rounding = "up"', 'rounding is "either" or "nearest", not "up"'),
    "flush": ("flush = true", "flush = 1", "flush is true or false"),
    "syntax": ("flush = true", "flush = ", "not valid TOML"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_broken_table_is_refused(case: str) -> None:
    old, new, sentence = BROKEN[case]
    text = (FOLDER / "wgsl.toml").read_text(encoding="utf-8")
    assert old in text
    with pytest.raises(UserError) as refused:
        read_table("wgsl", "tables/wgsl.toml", text.replace(old, new, 1))
    assert sentence in str(refused.value)
    assert str(refused.value).startswith("tables/wgsl.toml")


def test_missing_row_is_named() -> None:
    text = (FOLDER / "wgsl.toml").read_text(encoding="utf-8")
    start = text.index("[operations.floor]")
    end = text.index("[operations", start + 1)
    with pytest.raises(UserError, match="no row for floor"):
        read_table("wgsl", "tables/wgsl.toml", text[:start] + text[end:])


def test_unknown_table_is_refused() -> None:
    with pytest.raises(UserError, match='unknown accuracy table "wgls"; did you mean "wgsl"'):
        load_table("wgls")
