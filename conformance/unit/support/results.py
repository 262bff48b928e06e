"""A small measurement as data, made up: sin_angle and strand_cosine with their variants on one driver."""

from __future__ import annotations

from typing import Any

from codegen.library import Library
from conformance.bench.figures import Figure
from conformance.bench.inputs import groups
from conformance.bench.record import complete, described_device, function_data
from targets import Device

GROUPS = ("sin_angle", "strand_cosine")
WORDS = "a=3f800000 00000000 00000000;b=3f7fffff 00000000 00000000"
MESA = Device("glsl", "OpenGL 4.5", "Mesa 22.3.6", "llvmpipe (LLVM 15.0.6, 256 bits)")
POCL = Device("opencl", "OpenCL 3.0", "Portable Computing Language 3.1", "pthread")


def small_result(library: Library, device: Device = MESA) -> dict[str, Any]:
    """What a worker measured, completed as recorded files are; the k-th member takes 1 / (k + 1)."""
    functions, measured_groups = [], []
    for base in GROUPS:
        members = groups(library, [base])[0].members
        functions += [
            {
                **function_data(library, f, base),
                "speed": {mode: _speed(1.0 / (k + 1)) for mode in ("throughput", "latency")},
                "vectorised": {"lanes": 8, "how": "made up"},
                "error": _error(1e-7 * 10.0**k),
                "whole": None,
            }
            for k, f in enumerate(members)
        ]
        names = [f.name for f in members]
        mode = {"rounds": 3, "undecided": [names[:2]], "raw_ns": {name: [1.0, 1.1, 0.9] for name in names}}
        measured_groups.append({"base": base, "modes": {"throughput": mode, "latency": mode}})
    result = {
        "device": {"driver_name": "", **described_device(device)},
        "method": {"clock": "CPU time"},
        "self_checks": {"function": "sin_angle", "straight": 1.0, "same": 1.0},
        "functions": functions,
        "groups": measured_groups,
        "left_out": [],
        "figures": [Figure("sin_angle", "1e-7 rad", device.target, 5e-7, 2.8e-7, "relative").as_data()],
    }
    return complete(result, {"before": [0.0], "after": [0.0]})


def _speed(ratio: float) -> dict[str, Any]:
    return {
        "net_ns": ratio,
        "net_ns_quartiles": [0.9 * ratio, 1.1 * ratio],
        "gross_ns": 1.0 + ratio,
        "ratio": ratio,
        "ratio_quartiles": [0.9 * ratio, 1.1 * ratio],
    }


def _error(largest: float) -> dict[str, Any]:
    unit = {"p999": largest, "words": WORDS}
    return {
        "measure": "relative",
        "max": largest,
        "p999": largest,
        "median": 0.0,
        "not_finite": 0,
        "inputs": 9,
        "domain": "all",
        "ulp": {"largest": 2.0**23 * largest, **unit},
        "steps": {"largest": 255.0 * largest, **unit},
        "permitted": {"table": "glsl", "ulp": 2.0**25 * largest, "steps": 1e3 * largest, "guaranteed": 0.97},
    }
