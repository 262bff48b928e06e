"""Recorded measurements of speed beside error, read as data from conformance/bench/results."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

from codegen.errors import UserError
from codegen.ir.nodes import Function
from codegen.library import Library, default_root

SCHEMA = 2


def results_folder() -> Path:
    """Where `vair report --record` keeps one file per driver."""
    return default_root().parent / "conformance" / "bench" / "results"


@functools.cache
def recorded(folder: Path | None = None) -> tuple[dict[str, Any], ...]:
    """The recorded results, one per driver, in the order of their files; none where nothing is recorded.

    raises  UserError for a file that is no result of this schema
    """
    found = []
    for path in sorted((folder or results_folder()).glob("*.json")):
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
        except (json.JSONDecodeError, OSError) as e:
            raise UserError(f"{path.name}: not a readable result: {e}") from None
        if not isinstance(data, dict) or data.get("schema") != SCHEMA:
            raise UserError(
                f"{path.name}: not a result of schema {SCHEMA}; measure anew, vair report --record"
            )
        found.append(data)
    return tuple(found)


def entry(result: dict[str, Any], name: str) -> dict[str, Any] | None:
    """What one driver's result says of a function."""
    return next((f for f in result["functions"] if f["name"] == name), None)


def costs(library: Library, f: Function, folder: Path | None = None) -> list[dict[str, Any]]:
    """The recorded cost of a function per driver; `current`: its source is still what was measured."""
    found = []
    for result in recorded(folder):
        data = entry(result, f.name)
        if data is not None:
            found.append(
                {
                    "target": result["device"]["target"],
                    "driver": result["device"]["short"],
                    "base": data["base"],
                    "current": data["source_hash"] == library.select([f.name]).source_hash,
                    "speed": data["speed"],
                    "error": data["error"],
                }
            )
    return found
