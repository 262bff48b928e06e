"""Recorded results: one JSON file per driver and version under conformance/results, one line per function."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import asdict
from datetime import date
from pathlib import Path
from typing import Any

from codegen.files import write_text
from codegen.library import Library
from conformance.check.result import FunctionResult
from conformance.drivers.known import excess
from conformance.drivers.run import DriverRun

FOLDER = Path(__file__).parents[1] / "results"
FORMAT = 1
_TOKENS = re.compile(r"(?P<name>\w+)(?: = |: )|\[(?P<words>[0-9a-f ]+)\]|(?P<brace>[{}])")


def keep(library: Library, runs: Iterable[DriverRun], today: date, folder: Path = FOLDER) -> list[Path]:
    """Write the results into the files of their drivers; their other modes and functions stay as they are."""
    written = []
    for run in runs:
        path = folder / f"{run.driver.slug(run.device)}.json"
        data = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"modes": {}}
        data["modes"][run.mode.name] = merged(
            data["modes"].get(run.mode.name), mode_data(library, run, today)
        )
        whole = {
            "format": FORMAT,
            "driver": run.driver.name,
            "title": run.driver.title,
            "version": run.driver.version_of(run.device),
            "device": asdict(run.device),
            "modes": dict(sorted(data["modes"].items())),
        }
        write_text(path, as_text(whole))
        written.append(path)
    return written


def merged(before: dict[str, Any] | None, new: dict[str, Any]) -> dict[str, Any]:
    """A mode's data renewed: functions that were not run keep what was recorded, and so does the number of
    inputs, which speaks of the run of most functions."""
    if before is None or set(before["functions"]) <= set(new["functions"]):
        return new
    functions = {**before["functions"], **new["functions"]}
    return {**new, "inputs": before["inputs"], "functions": functions}


def mode_data(library: Library, run: DriverRun, today: date) -> dict[str, Any]:
    """The results of one mode as plain data."""
    return {
        "date": today.isoformat(),
        "sources": library.select().source_hash,
        "inputs": sum(r.lanes for r in run.results),
        "functions": {r.function: function_data(library, r) for r in run.results},
    }


def function_data(library: Library, r: FunctionResult) -> dict[str, Any]:
    """One function: how far it came, and its largest error under each bound with the input in hex."""
    data: dict[str, Any] = {
        "sources": library.select([r.function]).source_hash,
        "stage": r.stage,
        "within": r.passed,
        "non_finite": r.non_finite,
        "errors": [
            {"bound": b.limit, "measured": float(f"{b.measured:.4g}"), "worst": hex_words(b.worst)}
            for b in r.bounds
        ],
    }
    if r.broken:
        data["broken"] = r.broken.splitlines()[0][:200]
    if not r.passed:
        data["excess"] = str(excess(r)) if r.broken or r.non_finite else float(f"{excess(r):.4g}")
    if r.known:
        data["known"] = r.known
    return data


def hex_words(inputs: str) -> str:
    """The words of shown inputs with their names: `a 3f800000 0 0, b.x 3f000000`."""
    parts: list[str] = []
    outer: list[str] = []
    name = ""
    for token in _TOKENS.finditer(inputs):
        if token["words"]:
            parts.append(f"{'.'.join([*outer, name])} {token['words']}")
        elif token["brace"] == "{":
            outer.append(name)
        elif token["brace"]:
            outer.pop()
        else:
            name = token["name"]
    return ", ".join(parts)


def as_text(data: dict[str, Any]) -> str:
    """JSON with one line per function, so that a changed result is a changed line."""
    modes = []
    for name, mode in data["modes"].items():
        head = {key: value for key, value in mode.items() if key != "functions"}
        rows = [f"   {json.dumps(f)}: {json.dumps(v)}" for f, v in mode["functions"].items()]
        opening = json.dumps(head)[:-1]
        modes.append(f'  {json.dumps(name)}: {opening}, "functions": {{\n' + ",\n".join(rows) + "\n  }}")
    head = {key: value for key, value in data.items() if key != "modes"}
    return json.dumps(head, indent=1)[:-2] + ',\n "modes": {\n' + ",\n".join(modes) + "\n }\n}\n"


def read_all(folder: Path = FOLDER) -> dict[str, dict[str, Any]]:
    """Every recorded file by its name without the ending."""
    return {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))}


def stale(library: Library, recorded: dict[str, dict[str, Any]]) -> Iterable[tuple[str, str, list[str]]]:
    """File, mode and functions that were recorded of other sources than the library's, or not at all."""
    now = {name: library.select([name]).source_hash for name in library.public}
    for stem, data in recorded.items():
        for mode, results in data["modes"].items():
            then = {name: f["sources"] for name, f in results["functions"].items()}
            old = [name for name, digest in now.items() if then.get(name) != digest]
            if old:
                yield stem, mode, old
