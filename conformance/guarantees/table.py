"""guarantees.json: function -> table -> guarantee; writing, reading, comparing."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path

from codegen.intervals import TABLES
from codegen.library import Library
from conformance.guarantees.survey import Guarantee, drawn_for, survey

PATH = Path(__file__).with_name("guarantees.json")
SHARE_TOLERANCE = 2e-3
"""Shares that differ by less count as equal: lanes near a threshold depend on float64's last bits."""
ERROR_TOLERANCE = 0.06
"""The same for errors, relative: two significant digits, rounded up."""

Guarantees = dict[str, dict[str, Guarantee]]


def measured(library: Library, names: list[str] | None = None) -> Guarantees:
    """The guarantees of all public functions, or of some, under all tables."""
    found: Guarantees = {}
    for name in names or list(library.public):
        drawn = drawn_for(library, name)
        found[name] = {table: survey(library, name, table, drawn) for table in TABLES}
    return found


def text(guarantees: Guarantees) -> str:
    """The file: one line for each function and table."""
    blocks = []
    for name, by_table in guarantees.items():
        rows = [f"    {json.dumps(t)}: {json.dumps(_as_data(g))}" for t, g in by_table.items()]
        blocks.append(f"  {json.dumps(name)}: {{\n" + ",\n".join(rows) + "\n  }")
    return "{\n" + ",\n".join(blocks) + "\n}\n"


def _as_data(g: Guarantee) -> dict[str, object]:
    data: dict[str, object] = {"uniform": g.uniform, "hard": g.hard, "errors": [_number(e) for e in g.errors]}
    if g.causes:
        data["causes"] = g.causes
    return data


def _number(x: float | None) -> float | str | None:
    return "inf" if x is not None and math.isinf(x) else x


def read(path: Path = PATH) -> Guarantees:
    """The guarantees on file."""
    data = json.loads(path.read_text(encoding="utf-8"))
    return {
        name: {
            table: Guarantee(
                row["uniform"],
                row["hard"],
                [None if e is None else float(e) for e in row["errors"]],
                row.get("causes", {}),
            )
            for table, row in by_table.items()
        }
        for name, by_table in data.items()
    }


def differences(old: Mapping[str, Mapping[str, Guarantee]], new: Guarantees) -> list[str]:
    """What differs by more than the tolerances, one sentence each."""
    found = [f"{name}: no longer there" for name in old if name not in new]
    for name, by_table in new.items():
        for table, g in by_table.items():
            before = old.get(name, {}).get(table)
            if before is None:
                found.append(f"{name} under {table}: not on file")
                continue
            for what in ("uniform", "hard"):
                was, now = getattr(before, what), getattr(g, what)
                if abs(was - now) > SHARE_TOLERANCE:
                    found.append(f"{name} under {table}: guaranteed share ({what}) {was} became {now}")
            same = len(before.errors) == len(g.errors) and all(
                _close(a, b) for a, b in zip(before.errors, g.errors, strict=True)
            )
            if not same:
                found.append(f"{name} under {table}: guaranteed errors {before.errors} became {g.errors}")
    return found


def _close(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return a == b or abs(a - b) <= ERROR_TOLERANCE * max(abs(a), abs(b))
