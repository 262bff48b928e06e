"""The kept results of the estimators: one file for float64, one per driver."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from codegen.errors import UserError
from codegen.files import write_text
from conformance.bench.record import as_json, slug
from conformance.light.plan import SCHEMA

RESULTS = Path(__file__).parent / "results"
FLOAT64 = "float64"


def keep(section: dict[str, Any], folder: Path = RESULTS) -> list[Path]:
    """Write the data of the section, one line per curve; returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    texts = {folder / f"{FLOAT64}.json": as_json(section[FLOAT64])}
    texts |= {folder / f"{slug(d['device'])}.json": as_json(d) for d in section["drivers"]}
    for path, text in texts.items():
        write_text(path, text)
    return list(texts)


def recorded(folder: Path = RESULTS) -> dict[str, Any] | None:
    """The kept data of the section; None where nothing was kept. Raises UserError for other files."""
    paths = sorted(folder.glob("*.json"))
    found = {path.stem: _read(path) for path in paths}
    if FLOAT64 not in found:
        return None
    return {FLOAT64: found.pop(FLOAT64), "drivers": list(found.values())}


def _read(path: Path) -> dict[str, Any]:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        raise UserError(f"{path.name}: no result that can be read; measure anew") from None
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise UserError(f"{path.name}: no result of schema {SCHEMA}; measure anew")
    return data
