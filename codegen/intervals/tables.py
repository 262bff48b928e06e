"""Accuracy tables: what a specification promises for each operation, read from tables/<name>.toml."""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast

from codegen.errors import UserError, check_names, nearest, unknown
from codegen.intervals.accuracy import (
    Absolute,
    Accuracy,
    Exact,
    Filter,
    Inherited,
    Rounded,
    Row,
    Scaled,
    Ulp,
    Unstated,
)
from codegen.ops import BUILTINS, OPERATORS

FOLDER = Path(__file__).parent / "tables"
TABLES = ("wgsl", "vulkan", "glsl", "glsl_es", "opencl", "opencl_relaxed")
"""Names of the tables, in the order of reports."""
DEFAULT_TABLES: Mapping[str, str] = {"wgsl": "wgsl", "glsl": "glsl", "opencl": "opencl"}
"""The table that judges a target's default dialect."""

CAST = "cast"
"""The row for conversions between numbers, which are no operation of the registry."""
FORMULAS = (
    "1 / inverse_sqrt(x)",
    "sum of products, in any order",
    "x[i] y[j] - x[j] y[i]",
    "sqrt(dot(x, x))",
    "x / length(x)",
    "x inverse_sqrt(dot(x, x))",
    "x / length(x) or x inverse_sqrt(dot(x, x))",
)
"""The formulas that a row may inherit from; codegen.intervals evaluates them."""

_HEADER = ("specification", "edition", "rounding", "flush", "fused", "settings")
_OPTIONAL = "as_accurate"
_SETTINGS = ("rounding", "flush", "fused", "association")


@dataclass(frozen=True)
class Table:
    """One specification's promises.

    rounding  "either": correct rounding may go to either neighbour; "nearest": to nearest, ties to even
    flush     whether inputs and results below 2^-126 may become 0
    fused     whether a * b + c may be evaluated with one rounding
    as_accurate  whether only what is at least as accurate may be fused: not one side of a * b - a * b
    settings  why each of these, and of the order of sums, is as it is: one citing sentence each
    rows      operation -> what is promised
    """

    name: str
    specification: str
    edition: str
    rounding: Literal["either", "nearest"]
    flush: bool
    fused: bool
    settings: Mapping[str, str]
    rows: Mapping[str, Row]
    as_accurate: bool = False

    @property
    def contracts(self) -> bool:
        """Whether a * b + c may be evaluated with one rounding even where that makes it less accurate."""
        return self.fused and not self.as_accurate

    def row(self, operation: str) -> Row:
        """The row of an operation of the registry."""
        return self.rows[operation]


@functools.cache
def load_table(name: str) -> Table:
    """A table by name; raises UserError for an unknown name or a file that is not a table."""
    if name not in TABLES:
        raise unknown("accuracy table", name, TABLES)
    path = FOLDER / f"{name}.toml"
    return read_table(name, f"codegen/intervals/tables/{path.name}", path.read_text(encoding="utf-8"))


def read_table(name: str, shown: str, text: str) -> Table:
    """A table from TOML text; raises UserError naming the file, the row and the key."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as e:
        raise UserError(f"{shown}: not valid TOML: {e}") from None
    entries = data.pop("operations", {})
    _keys(shown, data, (*_HEADER, _OPTIONAL), _HEADER)
    _keys(f"{shown}: settings", data["settings"], _SETTINGS, _SETTINGS)
    if data["rounding"] not in ("either", "nearest"):
        raise UserError(f'{shown}: rounding is "either" or "nearest", not "{data["rounding"]}"')
    for key in ("flush", "fused", _OPTIONAL):
        if not isinstance(data.get(key, False), bool):
            raise UserError(f"{shown}: {key} is true or false")
    expected = [*OPERATORS, *BUILTINS, CAST]
    check_names(entries, expected, expected, f"{shown}: unknown operation", f"{shown}: no row for")
    rows = {operation: _row(f"{shown}: {operation}", operation, entries[operation]) for operation in expected}
    return Table(
        name,
        data["specification"],
        data["edition"],
        cast(Literal["either", "nearest"], data["rounding"]),
        data["flush"],
        data["fused"],
        data["settings"],
        rows,
        data.get(_OPTIONAL, False),
    )


def _keys(where: str, entry: Mapping[str, Any], allowed: tuple[str, ...], needed: tuple[str, ...]) -> None:
    check_names(entry, allowed, needed, f"{where}: unknown key", f"{where}: lacks")


# kind -> (keys it takes, keys it needs, value from the entry)
_Maker = Callable[[str, Mapping[str, Any]], Accuracy]
_KINDS: dict[str, tuple[tuple[str, ...], tuple[str, ...], _Maker]] = {
    "exact": ((), (), lambda where, e: Exact()),
    "rounded": ((), (), lambda where, e: Rounded()),
    "ulp": (
        ("ulps", "per_abs_x", "whole", "per_component", "reciprocal"),
        ("ulps",),
        lambda where, e: _ulp(where, e),
    ),
    "absolute": (
        ("bound", "within", "elsewhere_ulps"),
        ("bound", "within"),
        lambda where, e: _absolute(where, e),
    ),
    "inherited": (("formula",), ("formula",), lambda where, e: _inherited(where, e)),
    "scaled": (
        ("epsilons", "per_component"),
        ("epsilons",),
        lambda where, e: Scaled(float(e["epsilons"]), float(e.get("per_component", 0.0))),
    ),
    "filter": (
        ("texel", "level"),
        ("texel", "level"),
        lambda where, e: Filter(_positive(where, "texel", e["texel"]), _positive(where, "level", e["level"])),
    ),
    "unstated": ((), (), lambda where, e: Unstated()),
}
_ROW = ("kind", "cite", "assumed", "magnitude", "zero", "normal")


def _row(where: str, operation: str, entry: Mapping[str, Any]) -> Row:
    if "kind" not in entry:
        raise UserError(f"{where}: lacks kind; valid names: {', '.join(sorted(_KINDS))}")
    kind = entry["kind"]
    if kind not in _KINDS:
        raise UserError(f'{where}: unknown kind "{kind}"{nearest(str(kind), _KINDS)}')
    allowed, needed, make = _KINDS[kind]
    _keys(where, entry, (*_ROW, *allowed), ("kind", "cite", *needed))
    for key in ("cite", "assumed"):
        if key in entry and not (isinstance(entry[key], str) and entry[key].strip()):
            raise UserError(f"{where}: {key} is a sentence")
    names = operands(operation)
    magnitude = {}
    for operand, ends in entry.get("magnitude", {}).items():
        if operand not in names:
            raise UserError(f'{where}: no operand "{operand}"{nearest(operand, names)}')
        magnitude[operand] = cast(tuple[int, int], _ends(f"{where}: magnitude of {operand}", ends))
    reciprocal = entry.get("reciprocal")
    if reciprocal is not None:
        reciprocal = cast(tuple[int, int], _ends(f"{where}: reciprocal", reciprocal))
    for key in ("zero", "normal"):
        for operand in entry.get(key, ()):
            if operand not in names:
                raise UserError(f'{where}: no operand "{operand}"{nearest(operand, names)}')
    return Row(
        make(where, entry),
        entry["cite"],
        magnitude,
        reciprocal,
        tuple(entry.get("zero", ())),
        tuple(entry.get("normal", ())),
        entry.get("assumed", ""),
    )


def operands(operation: str) -> tuple[str, ...]:
    """Names of an operation's operands: x and y for operators."""
    return BUILTINS[operation].names if operation in BUILTINS else ("x", "y")


def _positive(where: str, key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not value > 0:
        raise UserError(f"{where}: {key} is a number above 0, not {value!r}")
    return float(value)


def _ends(where: str, ends: Any) -> tuple[float, float]:
    if not (isinstance(ends, list) and len(ends) == 2 and ends[0] <= ends[1]):
        raise UserError(f"{where}: needs two numbers in ascending order, not {ends!r}")
    return ends[0], ends[1]


def _ulp(where: str, entry: Mapping[str, Any]) -> Ulp:
    return Ulp(
        _positive(where, "ulps", entry["ulps"]),
        float(entry.get("per_abs_x", 0.0)),
        bool(entry.get("whole", False)),
        float(entry.get("per_component", 0.0)),
    )


def _absolute(where: str, entry: Mapping[str, Any]) -> Absolute:
    elsewhere = entry.get("elsewhere_ulps")
    return Absolute(
        _positive(where, "bound", entry["bound"]),
        _ends(f"{where}: within", entry["within"]),
        None if elsewhere is None else Ulp(_positive(where, "elsewhere_ulps", elsewhere)),
    )


def _inherited(where: str, entry: Mapping[str, Any]) -> Inherited:
    formula = entry["formula"]
    if formula not in FORMULAS:
        raise UserError(f'{where}: unknown formula "{formula}"{nearest(str(formula), FORMULAS)}')
    return Inherited(formula)
