"""A small section on estimators of light as data, made up: two lobes, one driver."""

from __future__ import annotations

from typing import Any

from conformance.bench.record import complete, described_device
from conformance.light.plan import SCHEMA
from conformance.unit.support.results import MESA

SAMPLES = [8, 64, 512]
LOBES = ["phong 10", "strand 10"]


def small_section() -> dict[str, Any]:
    """As conformance.light.run.measure gives it."""
    head = {
        "schema": SCHEMA,
        "version": "0",
        "date": "2026-01-01",
        "machine": {"cpu": "a processor"},
        "places": "6 frames",
        "method": {key: f"how the {key} was made" for key in ("truth", "error", "map", "time")},
        "maps": ["dawn"],
        "lobes": LOBES,
        "errors": [
            _curve(lobe, e, scale) for lobe in LOBES for e, scale in (("combined", 2.0), ("bias", 0.1))
        ],
        "figures": [
            {
                "what": "filtered importance sampling",
                "domain": "dawn, exponent 10",
                "driver": "",
                "goal": 0.03,
                "measured": 0.025,
                "unit": "relative RMS",
                "met": True,
            }
        ],
    }
    driver = {
        "schema": SCHEMA,
        "device": {"driver_name": "", **described_device(MESA)},
        "clock": "CPU time",
        "rounds": 3,
        "timed_map": "dawn",
        "errors": [
            _curve(lobe, e, scale) for lobe in LOBES for e, scale in (("monte_carlo", 1.0), ("filtered", 0.5))
        ],
        "times": [
            {
                "lobe": lobe,
                "estimator": e,
                "samples": [8, 512],
                "ns": [800.0, 51200.0],
                "quartiles": [[790.0, 810.0], [51000.0, 51500.0]],
            }
            for lobe in LOBES
            for e in ("monte_carlo", "filtered")
        ],
    }
    return {"float64": head, "drivers": [complete(driver, {"before": [0.0], "after": [0.0]})]}


def _curve(lobe: str, estimator: str, scale: float) -> dict[str, Any]:
    rms = [scale / n**0.5 for n in SAMPLES]
    return {"map": "dawn", "lobe": lobe, "estimator": estimator, "samples": SAMPLES, "rms": rms}
