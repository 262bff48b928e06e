"""The accuracy tables say what the specifications say, and verdicts end where the specifications end.

Plan.
  transcription  every row, told in a specification's own words, equals a second transcription that was made
                 operation by operation (specified_accuracy.toml): double entry, as these tables decide
  settings       the same for rounding, flushing and fusing
  edges          the last float that a specification permits is permitted, the one after it is not
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import TABLES, load_table, permitted
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
from codegen.intervals.tables import operands
from conformance.unit.support.sources import library_of

DATA: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("specified_accuracy.toml").read_text(encoding="utf-8")
)
SIGNIFICAND = 24
"""Bits of a float32's significand: its ULP is 2^(1 - 24) of the power of two below it."""


def number(x: float) -> str:
    """As specifications write numbers: whole, as a power of two or as a decimal fraction."""
    if abs(x) == math.pi:
        return "pi" if x > 0 else "-pi"
    exponent = math.log2(x) if 0 < x < 0.5 else 0.5
    return f"2^{exponent:.0f}" if exponent == int(exponent) else f"{x:g}"


def told(accuracy: Accuracy) -> str:
    """A promise in words."""
    match accuracy:
        case Exact():
            return "exact"
        case Rounded():
            return "correctly rounded"
        case Ulp(ulps, per_abs_x, whole, per_component):
            growing = f" + {per_abs_x:g} |x|" if per_abs_x else ""
            if whole:
                growing = f" + floor({per_abs_x:g} |x|)"
            sized = f" + {per_component:g} n" if per_component else ""
            return f"{ulps:g}{growing}{sized} ULP"
        case Absolute(bound, (low, high), elsewhere):
            rest = f", else {told(elsewhere)}" if elsewhere else ""
            return f"absolute {number(bound)} in [{number(low)}, {number(high)}]{rest}"
        case Inherited(formula):
            return f"inherited from {formula}"
        case Scaled(epsilons, per_component):
            count = f"{per_component:g} n - {-epsilons:g}" if per_component else f"{epsilons:g}"
            return f"{count} epsilons of the square of the largest component"
        case Filter(texel, level):
            return f"linear filtering with weights within {number(texel)} and {number(level)}"
        case Unstated():
            return "nothing"


def conditions(operation: str, row: Row) -> str:
    """For which operands the promise holds; empty where for all."""
    parts = []
    for name in operands(operation):
        if name in row.magnitude:
            low, high = row.magnitude[name]
            parts.append(f"|{name}| in [2^{low}, 2^{high}]" + (" or 0" if name in row.zero else ""))
        if name in row.normal:
            parts.append(f"{name} normal")
    if row.reciprocal is not None:
        low, high = row.reciprocal
        parts.append(f"or x = 1 and |y| in [2^{low}, 2^{high}]")
    return f" for {', '.join(parts)}" if parts else ""


def specified(operation: str, table: str) -> str:
    """What the second transcription says of an operation."""
    if operation in DATA["exact"]:
        return "exact"
    if operation in DATA["rounded"]:
        return "correctly rounded"
    (entry,) = [e for e in DATA["promise"] if operation in e["operations"]]
    return str(entry["says"][table])


@pytest.mark.parametrize("name", TABLES)
def test_rows_are_what_the_specification_says(name: str) -> None:
    table = load_table(name)
    found = {op: told(row.accuracy) + conditions(op, row) for op, row in table.rows.items()}
    assert found == {op: specified(op, name) for op in table.rows}


@pytest.mark.parametrize("name", TABLES)
def test_assumptions_are_those_that_were_made(name: str) -> None:
    made = {op for e in DATA["promise"] for op in e["operations"] if name in e.get("assumed", ())}
    assert {op for op, row in load_table(name).rows.items() if row.assumed} == made


@pytest.mark.parametrize("name", TABLES)
def test_settings_are_what_the_specification_says(name: str) -> None:
    table = load_table(name)
    neighbour = {"either": "either neighbour", "nearest": "nearest"}[table.rounding]
    flush, fuse = ("may" if given else "does not" for given in (table.flush, table.fused))
    what = " what stays as accurate" if table.as_accurate else ""
    assert f"rounds to {neighbour}, {flush} flush, {fuse} fuse{what}" == DATA["settings"][name]


def on_grid(x: Any, toward: int) -> np.float32:
    """The next float32 to an exact number, upwards for 1, downwards for -1."""
    near = np.float32(float(x))
    beyond = mpmath.mpf(float(near)) > x if toward < 0 else mpmath.mpf(float(near)) < x
    return np.nextafter(near, np.float32(toward * np.inf)) if beyond else near


EDGES = [(edge, table) for edge in DATA["edge"] for table in edge["error"]]


@pytest.mark.parametrize(("edge", "table"), EDGES, ids=lambda v: v if isinstance(v, str) else v["text"])
def test_verdicts_end_where_the_specification_ends(edge: dict[str, Any], table: str, tmp_path: Path) -> None:
    names = "ab"[: len(edge["inputs"])]
    parameters = ", ".join(f"{n}: X" for n in names)
    library = library_of(tmp_path, f"def probe({parameters}) -> f32:\n    return {edge['text']}\n")
    inputs = {n: np.array([x], np.float32) for n, x in zip(names, edge["inputs"], strict=True)}
    allowed = permitted(library, "probe", inputs, table)
    with mpmath.workdps(40):
        value: Any = evaluate(library, "probe", inputs, "mpmath")
        exact = mpmath.mpf(value[0])
        step = mpmath.mpf(2) ** (int(mpmath.floor(mpmath.log(abs(exact), 2))) + 1 - SIGNIFICAND)
        error = edge["error"][table] * (step if edge["unit"] == "ulp" else 1)
        for side in (-1, 1):
            inside = on_grid(exact + side * error, -side)
            outside = on_grid(exact + side * (error + step), side)
            assert allowed.contains(np.array([inside])).all(), (side, inside)
            assert not allowed.contains(np.array([outside])).any(), (side, outside)
