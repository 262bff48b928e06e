"""The recorded measurement: results.json, and the tables of README.md that are made of it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from codegen.files import write_text
from conformance.bench.handwritten.beside import BY_HAND, FIXED, Row
from conformance.bench.record import rounded
from conformance.marked import with_part

FOLDER = Path(__file__).parent
RESULTS, README = FOLDER / "results.json", FOLDER / "README.md"
BEGIN, END = (
    "<!-- results: written by python -m conformance.bench.handwritten --record -->",
    "<!-- end of results -->",
)
NAMES = {BY_HAND: "by hand", FIXED: "by hand, constants typed in"}


def as_data(about: Mapping[str, Any], found: Mapping[str, tuple[str, Sequence[Row]]]) -> dict[str, Any]:
    """The measurement as data: by target the driver and a row for each function."""
    targets = {
        target: {"driver": driver, "functions": [rounded(asdict(row)) for row in rows]}
        for target, (driver, rows) in found.items()
    }
    return {**about, "targets": targets}


def read() -> dict[str, Any]:
    """What is recorded."""
    found: dict[str, Any] = json.loads(RESULTS.read_text(encoding="utf-8"))
    return found


def keep(data: Mapping[str, Any]) -> None:
    """Write the data and the tables."""
    page = README.read_text(encoding="utf-8")
    made = with_part(page, BEGIN, END, f"\n\n{tables(data)}\n\n")
    write_text(RESULTS, json.dumps(data, indent=1) + "\n")
    write_text(README, made)


def tables(data: Mapping[str, Any]) -> str:
    """A table for each target, and how it was measured."""
    lines: list[str] = []
    for target, found in data["targets"].items():
        lines += [
            f"**{target}**, {found['driver']}",
            "",
            "| function | ns [quartiles] | of by hand | operations | ordinary | hard | not finite |",
            "|---|---:|---:|---:|---:|---:|---:|",
        ]
        rows = found["functions"]
        by_hand = next(row["ns"] for row in rows if row["function"] == BY_HAND)
        lines += [_line(row, by_hand) for row in rows]
        lines.append("")
    return "\n".join([*lines, f"{data['method']}. {data['date']}."])


def _line(row: Mapping[str, Any], by_hand: float) -> str:
    name = NAMES.get(row["function"]) or f"`{row['function']}`"
    operations = "" if row["operations"] is None else row["operations"]
    return (
        f"| {name} | {row['ns']:.3g} [{row['low']:.3g}, {row['high']:.3g}] | {row['ns'] / by_hand:.2f} "
        f"| {operations} | {row['ordinary']:.2g} | {row['hard']:.2g} | {row['non_finite']} |"
    )
