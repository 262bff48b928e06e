"""Rows of an accuracy table that promise too much, each with a text whose results show it."""

from __future__ import annotations

from dataclasses import replace

from codegen.intervals import Table
from codegen.intervals.accuracy import Absolute, Ulp

TOO_TIGHT: dict[str, tuple[str, Ulp | Absolute]] = {
    "1.0 / a": ("/", Ulp(0.1)),
    "inverse_sqrt(a)": ("inverse_sqrt", Ulp(0.1)),
    "sqrt(a)": ("sqrt", Ulp(0.1)),
    "exp(a)": ("exp", Ulp(0.1)),
    "exp2(a)": ("exp2", Ulp(0.1)),
    "log(a)": ("log", Absolute(1e-9, (0.5, 2.0), Ulp(0.1))),
    "log2(a)": ("log2", Absolute(1e-9, (0.5, 2.0), Ulp(0.1))),
    "sin(a)": ("sin", Absolute(1e-9, (-3.0, 3.0))),
    "cos(a)": ("cos", Ulp(0.1)),
    "atan2(a, 2.0)": ("atan2", Ulp(0.1)),
}
"""Text of a number a in [0.1, 2.9] -> operation and what the row promises of it."""


def tightened(table: Table, text: str) -> Table:
    """The table with the row of a text of TOO_TIGHT."""
    operation, accuracy = TOO_TIGHT[text]
    row = replace(table.row(operation), accuracy=accuracy)
    return replace(table, rows={**table.rows, operation: row})
