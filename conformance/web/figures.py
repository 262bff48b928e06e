"""The figures that the page shows: recorded speed beside error, and how far the printed formulas are off."""

from __future__ import annotations

from typing import Any

from codegen.costs import entry, recorded
from codegen.library import Library
from conformance.web.choices import Choices, Shading

BACKENDS = {"webgl2": "glsl", "webgpu": "wgsl"}
"""Backend of the page -> target whose record speaks for it: the same arithmetic in the same language."""
MODE = "throughput"
"""Independent evaluations, as fragments are."""


def records() -> dict[str, dict[str, Any]]:
    """By backend: on what was measured, and how."""
    return {backend: _record(result) for backend, result in _results().items()}


def figures(library: Library, shading: Shading) -> dict[str, dict[str, Any]]:
    """By backend: time and error of one variant, where they were recorded."""
    source_hash = library.select([shading.name]).source_hash
    found = {}
    for backend, result in _results().items():
        data = entry(result, shading.name)
        if data is None or data["error"] is None:
            continue
        speed, error = data["speed"][MODE], data["error"]
        found[backend] = {
            "base": data["base"],
            "current": data["source_hash"] == source_hash,
            "net_ns": speed["net_ns"],
            "ratio": speed["ratio"],
            "ratio_quartiles": speed["ratio_quartiles"],
            "error": {
                "measure": error["measure"],
                "max": error["max"],
                "steps": error["steps"]["largest"],
                "inputs": error["inputs"],
                "domain": error["domain"],
            },
        }
    return found


def misprint(choices: Choices) -> dict[str, Any]:
    """How far the printed formulas are from the right ones, in float64: numbers of the table of misprints."""
    from conformance.printed.catalogue import MISPRINTS
    from conformance.printed.misprint import measure, measure_every_light

    found = next(m for m in MISPRINTS if m.key == choices.misprint)
    example, every_light = measure(found), measure_every_light(found)
    assert every_light is not None
    return {
        "setting": found.setting.partition("; picture:")[0],
        "places": "over every pair of directions to light and viewer",
        "example": {"largest": example.largest, "mean": example.mean},
        "every_light": {"largest": every_light[0], "mean": every_light[1]},
    }


def _results() -> dict[str, dict[str, Any]]:
    by_target = {result["device"]["target"]: result for result in recorded()}
    return {backend: by_target[target] for backend, target in BACKENDS.items() if target in by_target}


def _record(result: dict[str, Any]) -> dict[str, Any]:
    device, method = result["device"], result["method"]
    return {
        "short": device["short"],
        "driver": f"{device['api']}, {device['driver']}",
        "device": device["device"],
        "cpu": result["machine"]["cpu"],
        "date": result["date"],
        "clock": method["clock"],
        "driver_threads": method["driver_threads"],
        "chains": method["throughput_chains"],
        "order": method["order"],
        "net": method["net"],
    }
