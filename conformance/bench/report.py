"""The tables that a person reads."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

from conformance.bench.selfcheck import EXPECTED

PIPE_WIDTH = 200
LETTERS = {"add": "+", "multiply": "*", "divide": "/", "root": "r", "exponential": "e", "trigonometric": "t"}
LEGEND = (
    "net ns per evaluation above a kernel that adds up the inputs; T throughput (eight chains), L latency "
    "(one chain), F flat (eight chains, no loop); ratio to the base with quartiles, for this driver only; "
    "error over uniform and hard inputs, of printed forms beside the printed formula; operations as written: "
    + ", ".join(f"{letter} {name}" for name, letter in LETTERS.items())
)


def console() -> Console:
    """Rich on a terminal; plain and wide in a pipe."""
    found = Console()
    return found if found.is_terminal else Console(width=PIPE_WIDTH, no_color=True)


def number(value: float | None, digits: int = 3) -> str:
    """A number shortly; a dash for none."""
    if value is None:
        return "-"
    return f"{value:.0f}" if 100.0 <= abs(value) < 1e4 else f"{value:.{digits}g}"


def ratio(speed: Mapping[str, Any]) -> str:
    """A ratio with its quartiles."""
    if speed["ratio"] is None:
        return "-"
    low, high = speed["ratio_quartiles"]
    return f"{speed['ratio']:.2f} [{low:.2f} {high:.2f}]"


def speed_table(result: Mapping[str, Any]) -> Table:
    """Speed against error on one driver."""
    d = result["device"]
    title = f"{d['short']}: {d['api']}; {d['driver']}; {d['device']}"
    table = Table(title=title, box=_box(), title_justify="left", caption=None)
    modes = list(dict.fromkeys(mode for f in result["functions"] for mode in f["speed"]))
    table.add_column("function", no_wrap=True)
    for mode in modes:
        table.add_column(f"{mode[0].upper()} ns", justify="right")
    for mode in modes:
        table.add_column(f"{mode[0].upper()} ratio", no_wrap=True)
    for heading in ("error", "max", "p99.9"):
        table.add_column(heading, justify="left" if heading == "error" else "right")
    table.add_column("operations", no_wrap=True)
    for f in result["functions"]:
        name = f["name"] if f["name"] == f["base"] else f"  {f['name']}"
        e = f["error"] or {"measure": "-", "max": None, "p999": None}
        table.add_row(
            name,
            *(number(f["speed"][mode]["net_ns"]) for mode in modes),
            *(ratio(f["speed"][mode]) for mode in modes),
            e["measure"],
            number(e["max"], 2),
            number(e["p999"], 2),
            operation_text(f["operations"]),
        )
    return table


def operation_text(counts: Mapping[str, int]) -> str:
    """Operation counts: 12* 9+ 1/ 2r."""
    return " ".join(f"{counts[name]}{letter}" for name, letter in LETTERS.items() if counts.get(name))


def self_check_line(result: Mapping[str, Any]) -> str:
    """The harness's own checks in one line."""
    checks = result["self_checks"]
    parts = [f"{name} {number(checks[name])} (should be {goal:g})" for name, goal in EXPECTED.items()]
    return f"self-checks on {checks['function']}: {', '.join(parts)}"


def figure_table(figures: Iterable[Mapping[str, Any]]) -> Table:
    """Goals and what was measured, one column per driver; the last one where no driver takes part."""
    rows: dict[tuple[Any, ...], dict[str, Mapping[str, Any]]] = {}
    for f in figures:
        rows.setdefault((f["what"], f["domain"], f["goal"], f["unit"]), {})[f["driver"]] = f
    drivers = list(dict.fromkeys(driver for row in rows.values() for driver in row))
    table = Table(title="Figures", box=_box(), title_justify="left")
    for heading in ("figure", "domain", "goal", *(d or "measured" for d in drivers), "unit", ""):
        table.add_column(heading, no_wrap=heading in ("figure", "unit"))
    for (what, domain, goal, unit), row in rows.items():
        measured = [number(row[d]["measured"]) if d in row else "" for d in drivers]
        table.add_row(
            what, domain, "" if goal is None else number(goal), *measured, unit, _verdict(row.values())
        )
    return table


def _verdict(figures: Iterable[Mapping[str, Any]]) -> str:
    found = {f["met"] for f in figures}
    return "NOT MET" if False in found else "met" if True in found else ""


def _box() -> box.Box | None:
    return box.SIMPLE if Console().is_terminal else None
