"""The worst inputs as records that `vair check --replay FILE` runs again."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import PurePosixPath
from typing import Any

from conformance.bench.record import slug
from conformance.check.identity import Identity
from conformance.report.model import UNITS

FOLDER = "worst"


def place(result: Mapping[str, Any], name: str) -> PurePosixPath:
    """Where the records of a function lie, within the report's folder."""
    return PurePosixPath(FOLDER) / slug(result["device"]) / f"{name}.json"


def records(result: Mapping[str, Any], entry: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The inputs of the largest error in each unit; one record where it is the same input.

    A peer's form has none: it is no function of the library.
    """
    found: dict[str, dict[str, Any]] = {}
    device, error = result["device"], entry["error"]
    for unit in UNITS if error is not None and entry["kind"] != "peer" else ():
        words = error[unit]["words"]
        if words and words not in found:
            found[words] = {
                "function": entry["name"],
                "target": device["target"],
                "driver": f"{device['api']}; {device['driver']}; {device['device']}",
                "identity": str(Identity(entry["name"], device["target"], "recorded", 1, 0, 0)),
                "source": entry["source_hash"],
                "seed": 0,
                "words": words,
                "got": f"the largest error in {unit}: {error[unit]['largest']:g}",
            }
    return list(found.values())


def files(results: Iterable[Mapping[str, Any]]) -> dict[PurePosixPath, str]:
    """Every file of records with its text."""
    return {
        place(result, entry["name"]): json.dumps(found, indent=1) + "\n"
        for result in results
        for entry in result["functions"]
        if (found := records(result, entry))
    }
