"""Finds into the stored tables: the worst input per function, target, driver and bound is kept for ever."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from codegen.library import Library
from conformance.cases import found
from conformance.search.climb import Find


def row_of(library: Library, find: Find) -> found.Row:
    """A find as a row of its section's table."""
    function = library.function(find.function)
    bound = find.bound
    field = f"{bound.field}: " if bound.field else ""
    return {
        "function": find.function,
        "target": find.target,
        "driver": find.driver,
        "measure": bound.measure,
        "domain": field + bound.domain,
        "error": f"{find.error:.4g}",
        "inputs": found.words(function, find.inputs),
    }


def key(row: found.Row) -> tuple[str, ...]:
    """What a row is the worst input of."""
    return tuple(row[name] for name in ("function", "target", "driver", "measure", "domain"))


def error_of(row: found.Row) -> float:
    """The error of a row; a result that is not finite is worse than any."""
    value = float(row["error"])
    return math.inf if math.isnan(value) else value


def keep(library: Library, finds: Iterable[Find], folder: Path = found.FOLDER) -> int:
    """Add the finds that beat what is stored; returns their number. Other sections' tables stay.

    An error of 0 is no find. Rows of functions that no longer exist, or whose bound has another domain now,
    are dropped.
    """
    fresh: dict[str, list[found.Row]] = {}
    for find in finds:
        if find.error > 0.0:
            fresh.setdefault(library.function(find.function).module, []).append(row_of(library, find))
    gained = 0
    for section, new in fresh.items():
        table = {key(row): row for row in found.rows(section, folder) if is_current(library, row)}
        for row in new:
            stored = table.get(key(row))
            if stored is None or error_of(row) > error_of(stored):
                table[key(row)] = row
                gained += 1
        found.write(section, table.values(), folder)
    return gained


def is_current(library: Library, row: found.Row) -> bool:
    """Whether the row speaks of a function and a bound that are there."""
    name = row["function"]
    if name not in library.public:
        return False
    domains = {f"{b.field}: {b.domain}" if b.field else b.domain for b in library.bounds_of(name)}
    try:
        inputs = found.inputs_of(library.function(name), [row["inputs"]])
    except ValueError:
        return False
    inside = found.inside_domains(library.function(name), inputs)
    return row["domain"] in domains and bool(inside.all())
