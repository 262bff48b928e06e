"""What the page shows, prepared from report.json: one list of groups, figures ready to be drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from codegen.library import Library
from conformance.report import worst
from conformance.report.model import UNITS, cost, label

MODES = {
    "throughput": "eight independent chains in a loop",
    "latency": "one chain, each evaluation waits for the last",
    "flat": "one chain without a loop",
}
PEER = "peer_"
"""What names of peers' forms begin with."""
KINDS = {"base": "default", "variant": "variant", "printed": "printed form", "peer": "peer's form"}


def view(library: Library, report: Mapping[str, Any]) -> dict[str, Any]:
    """Drivers, and groups with the entries of every driver."""
    results = report["drivers"]
    on_front = {(f["driver"], f["function"], f["mode"], f["unit"]): f["members"] for f in report["fronts"]}
    groups: dict[str, dict[str, Any]] = {}
    for number, result in enumerate(results):
        for entry in result["functions"]:
            base = entry["base"]
            group = groups.setdefault(base, {**_about(library, base), "entries": [], "open": {}})
            shown = _entry(result, entry)
            shown["driver"] = number
            shown["front"] = [
                f"{mode} {unit}"
                for mode in entry["speed"]
                for unit in UNITS
                if entry["name"] in on_front.get((label(result), base, mode, unit), ())
            ]
            group["entries"].append(shown)
        for measured in result["groups"]:
            for mode, data in measured["modes"].items():
                groups[measured["base"]]["open"][f"{number} {mode}"] = data["undecided"]
    return {
        "drivers": [{"label": label(r), **_device(r)} for r in results],
        "modes": [mode for mode in MODES if any(mode in f["speed"] for r in results for f in r["functions"])],
        "visits": max((len(v) for r in results for v in _visits(r)), default=1),
        "groups": sorted(groups.values(), key=lambda g: _order(library, g["name"])),
    }


def _visits(result: Mapping[str, Any]) -> list[Any]:
    """The visits to each group in each mode, where a result tells of them."""
    return [data["visits"] for g in result["groups"] for data in g["modes"].values() if "visits" in data]


def _about(library: Library, base: str) -> dict[str, Any]:
    """A group's name, section and what it computes; a name the library has lost still has its figures."""
    f = library.public.get(base)
    if f is None:
        return {"name": base, "section": "", "summary": ""}
    return {"name": base, "section": f.module, "summary": f.doc.summary}


def _order(library: Library, base: str) -> int:
    names = list(library.public)
    return names.index(base) if base in names else len(names)


def _device(result: Mapping[str, Any]) -> dict[str, Any]:
    device = result["device"]
    return {
        "short": device["short"],
        "target": device["target"],
        "says": "; ".join((device["api"], device["driver"], device["device"])),
        "clock": result["method"]["clock"],
        "date": result["date"],
    }


def _entry(result: Mapping[str, Any], entry: Mapping[str, Any]) -> dict[str, Any]:
    """One member on one driver."""
    error, foreign = entry["error"], entry["kind"] == "peer"
    name = entry["base"] if foreign else entry["name"]
    return {
        "name": entry["name"],
        "tag": short_name(entry["name"], entry["base"]),
        "kind": entry["kind"],
        "speed": {mode: _speed(speed) for mode, speed in entry["speed"].items()},
        "lanes": entry["vectorised"]["lanes"],
        "vectorised": entry["vectorised"]["how"],
        "operations": ", ".join(f"{count} {name}" for name, count in entry["operations"].items()),
        "domain": error["domain"] if error else "",
        "errors": {unit: _error(error, unit) for unit in UNITS} if error else None,
        "not_finite": error["not_finite"] if error else 0,
        "inputs": error["inputs"] if error else 0,
        "table": error["permitted"]["table"] if error and error["permitted"] else "",
        "replay": "" if foreign else f"vair check --replay {worst.place(result, name)}",
        "again": f"vair report -o DIR --function {name} --target {result['device']['target']}",
    }


def _speed(speed: Mapping[str, Any]) -> dict[str, Any]:
    low, high = speed["ratio_quartiles"] or (None, None)
    return {
        "ns": cost(speed),
        "net": speed["net_ns"],
        "quartiles": speed["net_ns_quartiles"],
        "ratio": speed["ratio"],
        "low": low,
        "high": high,
        "visits": speed.get("ratio_by_visit", []),  # results of single visits lack it
    }


def _error(error: Mapping[str, Any], unit: str) -> dict[str, Any]:
    permitted = error["permitted"]
    return {
        "max": error[unit]["largest"],
        "p999": error[unit]["p999"],
        "words": error[unit]["words"],
        "permitted": permitted[unit] if permitted else None,
        "guaranteed": permitted["guaranteed"] if permitted else None,
    }


def short_name(name: str, base: str) -> str:
    """What tells a member from its base: sq16 of strand_specular_sq16; the base is the default."""
    if name == base:
        return "default"
    stem = base.split("_")
    words = name.removeprefix(PEER).split("_")
    while stem and words and len(words) > 1 and stem[0] == words[0]:
        stem, words = stem[1:], words[1:]
    return " ".join(words)
