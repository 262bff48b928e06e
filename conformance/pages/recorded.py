"""What drivers were recorded to do with a function: errors under each bound, accuracy, time."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

from codegen.costs import costs
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.drivers.matrix import FORMAT
from conformance.drivers.record import read_all
from conformance.report.pareto import front

MODE = "default"
SPEED = "throughput"


@functools.cache
def files() -> Mapping[str, dict[str, Any]]:
    """The recorded results, by driver and version; files of older formats are left out."""
    return {name: data for name, data in read_all().items() if data["format"] == FORMAT}


def on_drivers(library: Library, f: Function) -> list[dict[str, Any]]:
    """One entry per driver that ran the function in its default mode.

    current  whether the sources are those that were recorded
    errors   the largest error under each declared bound that speaks of the driver's target, in turn; empty
             where other bounds were recorded
    """
    found = []
    source = library.select([f.name]).source_hash
    for data in files().values():
        mode = data["modes"].get(MODE)
        entry = mode["functions"].get(f.name) if mode else None
        if entry is None:
            continue
        target = data["device"]["target"]
        bounds = [b for b in library.bounds_of(f.name) if not b.targets or target in b.targets]
        found.append(
            {
                "driver": data["title"],
                "version": data["version"],
                "target": target,
                "date": mode["date"],
                "current": entry["sources"] == source,
                "within": entry["within"],
                "permitted": entry["permitted"],
                "table": entry.get("table", ""),
                "inputs": entry["inputs"],
                "errors": [e["measured"] for e in entry["errors"]]
                if [e["bound"] for e in entry["errors"]] == [b.bound for b in bounds]
                else [],
                "accuracy": entry["accuracy"],
                "known": entry.get("known", {}),
            }
        )
    return found


def times(library: Library, f: Function) -> list[dict[str, Any]]:
    """The recorded time per driver: nanoseconds of a base function, a multiple of them of the others."""
    found = []
    for cost in costs(library, f):
        speed = cost["speed"].get(SPEED)
        if speed is not None:
            found.append({**cost, "ns": speed["net_ns"], "ratio": speed["ratio"]})
    return found


def group_points(library: Library, base: str) -> dict[str, list[dict[str, Any]]]:
    """Driver -> time and error of each member of a group, with whether it is on the front.

    Printed forms are left out: their error is against another formula.
    """
    found: dict[str, list[dict[str, Any]]] = {}
    for f in [library.function(base), *library.variants(base)]:
        for time in times(library, f) if f.kind in ("base", "variant") else ():
            error = time["error"]
            if error is None or error["max"] is None or error["not_finite"]:
                continue
            found.setdefault(time["driver"], []).append(
                {
                    "name": f.name,
                    "kind": f.kind,
                    "ns": max(float(time["ns"]), 1e-3),
                    "error": float(error["max"]),
                    "measure": error["measure"],
                }
            )
    for points in found.values():
        best = front({p["name"]: (p["ns"], p["error"]) for p in points})
        for p in points:
            p["front"] = p["name"] in best
    return {driver: points for driver, points in found.items() if len(points) > 1}
