"""Recorded times of compiling includes: results.json, and the table of README.md that is made of it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from codegen.files import write_text
from conformance.bench.compile.shells import SHELLS, Shell
from conformance.bench.compile.times import Taken, Times
from conformance.marked import with_part

FOLDER = Path(__file__).parent
RESULTS, README = FOLDER / "results.json", FOLDER / "README.md"
BEGIN, END = (
    "<!-- results: written by python -m conformance.bench.compile --record -->",
    "<!-- end of results -->",
)


def read() -> dict[str, Any]:
    """What is recorded: about the measurement, and rows by shell."""
    found: dict[str, Any] = json.loads(RESULTS.read_text(encoding="utf-8"))
    return found


def as_data(
    about: Mapping[str, Any], found: Mapping[Shell, Sequence[Times]], everything: Mapping[Shell, Taken]
) -> dict[str, Any]:
    """The measurement as data; times in ms, the dearest function first; everything: all functions."""
    rows = {
        shell.name: [
            {
                "function": t.function,
                "whole": _rounded(t.whole),
                "empty": _rounded(t.empty),
                "above": round(t.above, 1),
                "more": None if t.more is None else round(t.more, 1),
            }
            for t in sorted(times, key=lambda t: -t.whole.median)
        ]
        for shell, times in found.items()
    }
    library = {shell.name: _rounded(taken) for shell, taken in everything.items()}
    return {**about, "shells": rows, "library": library}


def _rounded(taken: Taken) -> dict[str, float]:
    return {"median": round(taken.median, 1), "least": round(taken.least, 1)}


def keep(data: Mapping[str, Any]) -> None:
    """Write the data and the table."""
    write_text(RESULTS, json.dumps(data, indent=1) + "\n")
    page = README.read_text(encoding="utf-8")
    write_text(README, with_part(page, BEGIN, END, f"\n\n{table(data)}\n\n"))


def table(data: Mapping[str, Any]) -> str:
    """One row for each shell: its empty shader, and the largest time of any function."""
    lines = [
        "| include | shader | empty, ms | dearest function | whole, ms | above, ms | one more, ms "
        "| all functions, ms |",
        "|---|---|---:|---|---:|---:|---:|---:|",
    ]
    for shell in SHELLS:
        if shell.name not in data["shells"]:
            continue
        first, everything = data["shells"][shell.name][0], data["library"][shell.name]
        more = "" if first["more"] is None else f"{first['more']:.0f}"
        lines.append(
            f"| `{shell.dialect}` | {shell.name} | {_told(first['empty'])} | `{first['function']}` "
            f"| {_told(first['whole'])} | {first['above']:.0f} | {more} | {_told(everything)} |"
        )
    return "\n".join([*lines, "", dearest(data["shells"]), "", f"{data['method']}. {data['date']}."])


def dearest(shells: Mapping[str, Sequence[Mapping[str, Any]]]) -> str:
    """A sentence on what an include adds at most, and where."""
    rows = [(row["above"], row["function"], name) for name, rows in shells.items() for row in rows]
    above, function, name = max(rows)
    return (
        f"The most that an include adds to the empty shader of its row: {above:.0f} ms, `{function}`, {name}."
    )


def _told(taken: Mapping[str, float]) -> str:
    return f"{taken['median']:.0f} ({taken['least']:.0f})"
