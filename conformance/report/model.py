"""report.json: all that was measured, and the fronts that follow from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from codegen.documents import read_json
from codegen.errors import UserError
from codegen.library import Library
from codegen.version import VERSION
from conformance.bench.record import SCHEMA as RESULT_SCHEMA
from conformance.bench.record import machine_data
from conformance.report.agreement import agreement
from conformance.report.pareto import Point, front

SCHEMA = 1
UNITS = ("ulp", "steps")
"""Units of the error: float32's spacing at the value, and steps of an 8-bit channel."""
DAMAGED = (ArithmeticError, AttributeError, IndexError, KeyError, TypeError, ValueError)
"""What a report raises whose values are others than vair report writes."""
HALF_STEP = 0.5
"""What rounding to the nearest 8-bit step hides, in steps."""
RESOLVED = 0.01
"""Net times below this share of the whole time count as this share, so that a logarithm exists."""

Result = Mapping[str, Any]


def build(
    library: Library,
    results: list[dict[str, Any]],
    *,
    command: str,
    recorded: bool = False,
    skipped: Mapping[str, str] | None = None,
    emission: list[dict[str, Any]] | None = None,
    scenes: list[dict[str, Any]] | None = None,
    light: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """The whole report as plain data.

    results   one per driver, as conformance.bench.run.measure gives them
    command   what was typed
    recorded  whether the results are the kept ones, measured at their own dates
    skipped   label of a driver -> why it was not measured
    light     of the estimators of light, as conformance.light.run.measure gives it
    """
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "source_hash": library.select().source_hash,
        "command": command,
        "recorded": recorded,
        "machine": machine_data(),
        "skipped": dict(skipped or {}),
        "drivers": results,
        "fronts": [f for result in results for f in fronts(result)],
        "emission": emission or [],
        "scenes": scenes or [],
        "light": light,
    }


def cost(speed: Mapping[str, Any]) -> float:
    """Nanoseconds per evaluation above the loop, positive."""
    return max(float(speed["net_ns"]), RESOLVED * float(speed["gross_ns"]))


def error_in(entry: Mapping[str, Any], unit: str) -> float | None:
    """The largest error of an entry in a unit; None where it has none, or a result was not finite."""
    error = entry["error"]
    if error is None or error["not_finite"] or error[unit]["largest"] is None:
        return None
    return float(error[unit]["largest"])


def candidates(result: Result, base: str) -> list[Mapping[str, Any]]:
    """The members of a group that the library offers: the base and its variants."""
    return [f for f in result["functions"] if f["base"] == base and f["kind"] in ("base", "variant")]


def fronts(result: Result) -> Iterable[dict[str, Any]]:
    """The Pareto fronts of one driver: for every group, mode and unit the members on it, cheapest first."""
    for base in dict.fromkeys(f["base"] for f in result["functions"]):
        members = candidates(result, base)
        for mode in members[0]["speed"]:
            for unit in UNITS:
                points: dict[str, Point] = {}
                for f in members:
                    error = error_in(f, unit)
                    if error is not None:
                        points[f["name"]] = (cost(f["speed"][mode]), error)
                yield {
                    "driver": label(result),
                    "function": base,
                    "mode": mode,
                    "unit": unit,
                    "members": front(points),
                }


def label(result: Result) -> str:
    """A driver as the page calls it: name and target."""
    d = result["device"]
    return f"{d['short']} ({d['target']})"


def read_report(path: Path) -> dict[str, Any]:
    """A report.json, or a folder that holds one; raises UserError for anything else."""
    file = path / "report.json" if path.is_dir() else path
    try:
        data = read_json(file)
    except UserError as e:
        raise UserError(f"{e}; vair report writes a report.json into its folder") from None
    drivers = data.get("drivers") if isinstance(data, dict) else None
    if not isinstance(drivers, list) or data.get("schema") != SCHEMA:
        raise UserError(f'"{file}" is no report of schema {SCHEMA}; write it anew with vair report')
    if any(not isinstance(r, dict) or r.get("schema") != RESULT_SCHEMA for r in drivers):
        raise UserError(f'"{file}" holds results of another schema than {RESULT_SCHEMA}; measure anew')
    try:
        agreement(drivers, drivers)  # takes all that a comparison needs
    except DAMAGED as e:
        raise UserError(f'"{file}" is damaged: a result lacks or misspells {e}') from None
    found: dict[str, Any] = data
    return found
