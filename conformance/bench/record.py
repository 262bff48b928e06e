"""Results as data: what a recorded file holds, in an order and with digits that do not vary by themselves."""

from __future__ import annotations

import json
import math
import os
import platform
import re
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from codegen.ir.nodes import Function
from codegen.library import Library
from codegen.passes.analysis.operations import operations_by_cost
from codegen.version import VERSION
from conformance.bench.accuracy import Error
from conformance.bench.joining import GroupTiming, Timing
from conformance.bench.kernels import THROUGHPUT
from conformance.bench.ratios import Spread
from conformance.bench.steady import Rounds
from conformance.bench.timing import Bench
from conformance.peers import PEERS
from targets import Device

SCHEMA = 2
RESULTS = Path(__file__).parent / "results"
DIGITS = 4
PACKAGES = ("numpy", "moderngl", "wgpu", "pyopencl")


def rounded(value: Any) -> Any:
    """Numbers to four significant digits, all through nested data; what is not finite becomes None."""
    if isinstance(value, dict):
        return {key: rounded(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(v) for v in value]
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
    return value


def short_name(device: Device) -> str:
    """A driver as people call it: llvmpipe, lavapipe, PoCL; else the device's own name."""
    driver, name = device.driver.lower(), device.device.lower()
    if "portable computing" in driver:
        return "PoCL"
    if "rusticl" in driver:
        return "Rusticl"
    if "swiftshader" in name:
        return "SwiftShader"
    if "llvmpipe" in name:
        mesa = "llvmpipe" if device.target == "glsl" else "lavapipe"
        return "wgpu on OpenGL" if "on OpenGL" in device.api else mesa
    return device.device


def slug(device: dict[str, str]) -> str:
    """The stem of a result's file: glsl-llvmpipe, wgsl-lavapipe, opencl-pocl."""
    return re.sub(r"[^a-z0-9]+", "-", f"{device['target']} {device['short']}".lower()).strip("-")


def described_device(device: Device) -> dict[str, str]:
    """The device, and what it is called for short."""
    return {"short": short_name(device), **vars(device)}


def method_data(bench: Bench) -> dict[str, Any]:
    """How the times were taken."""
    return {
        "clock": bench.clock_name,
        "driver_threads": 1 if bench.software else None,
        "order": "every kernel forwards and backwards in each round (A B B A), the first one changing",
        "visits": "each in a process of its own, until orders are reproducible",
        "rounds": [bench.effort.rounds, max(bench.effort.most, bench.effort.rounds)],
        "lanes": bench.lanes,
        "throughput_chains": THROUGHPUT.chains,
        "net": "above a kernel that adds up the inputs instead",
    }


def function_data(library: Library, f: Function, base: str) -> dict[str, Any]:
    """What identifies a function in the results."""
    return {
        "name": f.name,
        "base": base,
        "kind": "peer" if f.name in PEERS else f.kind,
        "source_hash": library.select([f.name]).source_hash,
        "operations": operations_by_cost(f, library),
    }


def timing_data(t: Timing) -> dict[str, Any]:
    """One mode's times; the ratio is None where the base's net time is lost in the noise."""
    return {
        "net_ns": t.net_ns.median,
        "net_ns_quartiles": quartiles(t.net_ns),
        "gross_ns": t.gross_ns,
        "ratio": t.ratio.median if t.ratio is not None else None,
        "ratio_quartiles": quartiles(t.ratio) if t.ratio is not None else None,
        "ratio_by_visit": list(t.by_visit),
    }


def quartiles(s: Spread) -> list[float]:
    """Lower and upper quartile."""
    return [s.low, s.high]


def error_data(e: Error, domain: str) -> dict[str, Any]:
    """The error beside a speed."""
    return {
        "measure": e.measure,
        "max": e.largest,
        "p999": e.p999,
        "median": e.median,
        "not_finite": e.non_finite,
        "inputs": e.count,
        "domain": domain,
        "ulp": vars(e.ulp),
        "steps": vars(e.steps),
        "permitted": vars(e.permitted) if e.permitted is not None else None,
    }


def group_data(t: GroupTiming, steps: int, lanes: int) -> dict[str, Any]:
    """What the visits to a group in one mode were, and which pairs they leave open.

    steps, lanes  of each launch
    """
    raw: dict[str, list[float]] = {}
    for rounds in t.visits:
        for name, times in rounds.items():
            raw.setdefault(name, []).extend(times)
    return {
        "rounds": sum(_count(rounds) for rounds in t.visits),
        "undecided": [list(pair) for pair in t.undecided],
        "visits": [{"rounds": _count(rounds), "members": len(rounds) - 1} for rounds in t.visits],
        "steps": steps,
        "lanes": lanes,
        "raw_ns": raw,
        "raw_visits": [list(rounds) for rounds in t.visits],
    }


def _count(rounds: Rounds) -> int:
    return len(next(iter(rounds.values())))


RAW = ("raw_ns", "raw_visits")


def without_raw(result: dict[str, Any]) -> dict[str, Any]:
    """A driver's result as it is kept: all but the times of single rounds."""
    groups = [
        {
            **g,
            "modes": {
                mode: {key: value for key, value in data.items() if key not in RAW}
                for mode, data in g["modes"].items()
            },
        }
        for g in result["groups"]
    ]
    return {**result, "groups": groups}


def machine_data() -> dict[str, Any]:
    """The machine and what was installed."""
    return {
        "cpu": cpu_name(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "packages": {name: _installed(name) for name in PACKAGES},
    }


def cpu_name() -> str:
    """The processor's name, with its family and model where the name alone says little."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor() or platform.machine()
    found = dict(re.findall(r"^(model name|cpu family|model)\s*: (.*)$", text, re.MULTILINE))
    name = found.get("model name", platform.machine())
    return f"{name}, family {found.get('cpu family', '?')} model {found.get('model', '?')}"


def _installed(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def complete(result: dict[str, Any], load: dict[str, list[float]]) -> dict[str, Any]:
    """A worker's result with everything that a recorded file says."""
    head = {
        "schema": SCHEMA,
        "version": VERSION,
        "date": datetime.now(UTC).date().isoformat(),
        "device": result["device"],
        "machine": machine_data(),
    }
    whole: dict[str, Any] = rounded({**head, "load_average": load, **result})
    return whole


def as_json(result: Mapping[str, Any]) -> str:
    """The text of a recorded file: one line per entry of a list, so that a changed result is one line."""
    rows = []
    for key, value in result.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            entries = ",\n  ".join(json.dumps(v) for v in value)
            rows.append(f" {json.dumps(key)}: [\n  {entries}\n ]")
        else:
            rows.append(f" {json.dumps(key)}: {json.dumps(value)}")
    return "{\n" + ",\n".join(rows) + "\n}\n"
