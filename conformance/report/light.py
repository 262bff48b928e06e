"""What the page shows of the estimators of light: curves by driver, map and lobe, and a table to read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from conformance.light.modelled import BIAS, HOST_SIDE
from conformance.light.record import FLOAT64

ESTIMATORS = {
    "grid": "grid",
    "monte_carlo": "Monte Carlo",
    "filtered": "filtered",
    "guarded": "guarded",
    HOST_SIDE: "lobe and map",
    "prefiltered": "prefiltered",
    BIAS: "bias of filtered",
}
"""Estimators in the order of the legend, and what the page calls them."""
TABLE_SAMPLES = 64
"""The table shows the errors and times of this many samples: what a game may afford."""


def light_view(section: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """The section's data for the script and for the table; None where nothing was measured.

    drivers  label and kind; the last one is float64
    errors   one list per driver: [map, lobe, estimator, samples, errors]
    times    one list per driver: [lobe, estimator, samples, nanoseconds]
    rows     of the table: driver, map, lobe and a cell for each estimator
    """
    if section is None:
        return None
    head, drivers = section[FLOAT64], section["drivers"]
    names = [f"{d['device']['short']} ({d['device']['target']})" for d in drivers]
    shown = {
        "drivers": [*names, "float64, without a driver"],
        "maps": head["maps"],
        "lobes": head["lobes"],
        "estimators": ESTIMATORS,
        "errors": [[_curve(c) for c in d["errors"]] for d in (*drivers, head)],
        "times": [[[t["lobe"], t["estimator"], t["samples"], t["ns"]] for t in d["times"]] for d in drivers]
        + [[]],
    }
    rows = [row for k, d in enumerate(drivers) for row in _rows(k, d, head)]
    return {"data": shown, "rows": rows, "samples": TABLE_SAMPLES, "columns": _columns(head, drivers)}


def _curve(c: Mapping[str, Any]) -> list[Any]:
    return [c["map"], c["lobe"], c["estimator"], c["samples"], c["rms"]]


def _columns(head: Mapping[str, Any], drivers: Sequence[Mapping[str, Any]]) -> list[str]:
    """The estimators that have a curve of more than a point, in order; the bias is no estimator."""
    present = {c["estimator"] for d in (*drivers, head) for c in d["errors"]}
    return [name for name in ESTIMATORS if name in present and name != BIAS]


def _rows(number: int, driver: Mapping[str, Any], head: Mapping[str, Any]) -> list[dict[str, Any]]:
    """One driver's rows: for every map and lobe the error and the microseconds of each estimator."""
    errors = {(c["map"], c["lobe"], c["estimator"]): c for c in (*head["errors"], *driver["errors"])}
    times = {(t["lobe"], t["estimator"]): t for t in driver["times"]}
    columns = _columns(head, [driver])
    found = []
    for name in head["maps"]:
        for lobe in head["lobes"]:
            cells = []
            for estimator in columns:
                curve, time = errors.get((name, lobe, estimator)), times.get((lobe, estimator))
                cells.append(
                    {
                        "error": at(curve["samples"], curve["rms"]) if curve else None,
                        "us": at(time["samples"], time["ns"]) if time else None,
                    }
                )
            best = min((c["error"] for c in cells if c["error"] is not None), default=None)
            for cell in cells:
                cell["best"] = cell["error"] is not None and cell["error"] == best
                cell["us"] = cell["us"] / 1e3 if cell["us"] is not None else None
            found.append({"driver": number, "map": name, "lobe": lobe, "cells": cells})
    return found


def at(samples: Sequence[int], values: Sequence[float | None]) -> float | None:
    """The value at TABLE_SAMPLES, on a line between its neighbours; of a single point that point."""
    if len(samples) == 1:
        return values[0]
    if not samples or samples[-1] < TABLE_SAMPLES or any(v is None for v in values):
        return None
    exact = [v for n, v in zip(samples, values, strict=True) if n == TABLE_SAMPLES]
    return exact[0] if exact else float(np.interp(TABLE_SAMPLES, samples, np.array(values, np.float64)))
