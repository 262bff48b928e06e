"""Everything that is measured of the estimators, as data: in float64 once, then on every driver."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.version import VERSION
from conformance.bench.record import machine_data, rounded
from conformance.bench.run import Place, Watch, in_worker, side_by_side
from conformance.light import modelled
from conformance.light.environment import Environment, MapSampler
from conformance.light.goals import goals
from conformance.light.lobes import Lobe
from conformance.light.plan import SCHEMA, Plan
from conformance.light.worker import Job, Truths

Array = npt.NDArray[np.float64]

LABEL = "float64"
"""What the part without a driver is called in messages."""
METHOD = {
    "truth": "the sum over every texel of the latitude-longitude map in float64, exact solid angles",
    "error": "root of the mean square error over places and channels, over that of the truth",
    "map": "dual paraboloid, 256 x 256 texels a disc, border 1.2, levels weighted by solid angle",
    "time": "per shaded point, above an empty launch; all estimators and numbers of samples of a lobe "
    "in turn, forwards and backwards, on one thread",
}


def measure(
    where: Sequence[Place],
    chosen: Plan,
    watch: Watch = lambda label, event: None,
    *,
    at_once: int = 2,
    quick: bool = False,
) -> tuple[dict[str, Any], dict[str, str]]:
    """The data of the report's section on estimators; and by label why drivers are missing.

    returns  float64: what needs no driver, see README.md; drivers: one object each
    """
    modelled_data, truths = in_float64(chosen, watch, at_once=at_once, quick=quick)
    drivers, missing = on_drivers(where, chosen, truths, watch, at_once=at_once)
    return {LABEL: modelled_data, "drivers": drivers}, missing


def in_float64(
    chosen: Plan, watch: Watch, *, at_once: int, quick: bool = False
) -> tuple[dict[str, Any], Truths]:
    """What needs no driver: errors of the estimators in float64, and the promised figures; and the truths."""
    watch(LABEL, {"event": "started", "total": len(chosen.lobes)})
    truths: dict[str, dict[str, Array]] = {name: {} for name in chosen.maps}
    errors: list[dict[str, Any]] = []
    with ProcessPoolExecutor(min(at_once, os.cpu_count() or 1)) as pool:
        for lobe, (truth, curves) in zip(
            chosen.lobes, pool.map(_of_lobe, [chosen] * len(chosen.lobes), chosen.lobes), strict=True
        ):
            for name in chosen.maps:
                truths[name][str(lobe)] = truth[name]
                for e, curve in curves[name].items():
                    errors.append({"map": name, "lobe": str(lobe), "estimator": e, **asdict(curve)})
            watch(LABEL, {"event": "done", "what": str(lobe)})
    data: dict[str, Any] = rounded(
        {
            "schema": SCHEMA,
            "version": VERSION,
            "date": datetime.now(UTC).date().isoformat(),
            "machine": machine_data(),
            "places": chosen.described(),
            "method": METHOD,
            "maps": list(chosen.maps),
            "lobes": [str(lobe) for lobe in chosen.lobes],
            "errors": errors,
            "figures": [figure.as_data() for figure in goals(quick=quick)],
        }
    )
    return data, truths


def on_drivers(
    where: Sequence[Place], chosen: Plan, truths: Truths, watch: Watch, *, at_once: int
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """Errors and times of the emitted functions, one object per driver; and why others are missing."""

    def work(place: Place, seconds: float) -> dict[str, Any] | str:
        job = Job(place.target, place.driver, chosen, truths)
        return in_worker("conformance.light.worker", place, job.to_json(), watch)

    return side_by_side(where, at_once, 0.0, work)


@cache
def _maps(chosen: Plan) -> tuple[dict[str, Environment], dict[str, MapSampler]]:
    """The maps of a plan, read once in every process."""
    maps = modelled.environments(chosen)
    return maps, {name: MapSampler(here) for name, here in maps.items()}


def _of_lobe(chosen: Plan, lobe: Lobe) -> tuple[dict[str, Array], dict[str, dict[str, modelled.Curve]]]:
    """Quadratures and curves by map."""
    maps, samplers = _maps(chosen)
    truth = modelled.truths(chosen, lobe, maps)
    samples = modelled.drawn(chosen, lobe)
    return truth, {
        name: modelled.curves(chosen, lobe, here, samplers[name], truth[name], samples)
        for name, here in maps.items()
    }
