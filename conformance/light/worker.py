"""Measures the emitted estimators on one driver in a process of its own; see conformance.bench.worker.

The job comes as JSON on standard input: the plan and the quadratures, which are the same for all drivers.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate.textures import TextureMap
from codegen.library import Library, load_library
from conformance.bench.record import described_device
from conformance.bench.timing import QUICK, Bench
from conformance.bench.worker import Say, opened_driver, serve
from conformance.light import emitted, modelled, prefiltered
from conformance.light.lobes import Lobe
from conformance.light.plan import SCHEMA, Plan

Truths = Mapping[str, Mapping[str, npt.NDArray[np.float64]]]
"""Quadratures (views, 3) by map and lobe."""


@dataclass(frozen=True)
class Job:
    """What to measure where: a plan, the quadratures, a target and a driver's name (or none)."""

    target: str
    driver: str
    plan: Plan
    truths: Truths

    def to_json(self) -> str:
        """The job as text."""
        lobes = [[lobe.name, lobe.parameters] for lobe in self.plan.lobes]
        truths = {m: {lobe: t.tolist() for lobe, t in rows.items()} for m, rows in self.truths.items()}
        return json.dumps(
            {
                "target": self.target,
                "driver": self.driver,
                "plan": {**asdict(self.plan), "lobes": lobes},
                "truths": truths,
            }
        )

    @staticmethod
    def from_json(text: str) -> Job:
        """The job that to_json wrote."""
        data = json.loads(text)
        given: dict[str, Any] = {
            key: tuple(v) if isinstance(v, list) else v for key, v in data["plan"].items()
        }
        given["lobes"] = tuple(Lobe(name, tuple(parameters)) for name, parameters in given["lobes"])
        truths = {m: {k: np.array(t) for k, t in rows.items()} for m, rows in data["truths"].items()}
        return Job(data["target"], data["driver"], Plan(**given), truths)


def measure(job: Job, library: Library, say: Say) -> dict[str, Any]:
    """All errors and times on one driver, as data."""
    runtime = opened_driver(job.target, job.driver)
    chosen = job.plan
    say("started", total=len(chosen.lobes) + 1)
    bench = Bench(library, runtime, replace(QUICK, rounds=chosen.rounds, most=chosen.rounds))
    environments = modelled.environments(chosen)
    maps = {name: emitted.texture(here) for name, here in environments.items()}
    say("done", what="maps")
    errors: list[dict[str, Any]] = []
    times: list[dict[str, Any]] = []
    for lobe in chosen.lobes:
        label = str(lobe)
        names = {e: emitted.function_of(e, lobe) for e in emitted.BY_LOBE}
        for m, env in maps.items():
            for e in names:
                curve = emitted.errors(library, runtime, e, chosen, lobe, env, job.truths[m][label])
                errors.append({"map": m, "lobe": label, "estimator": e, **asdict(curve)})
        one: TextureMap | None = None
        exponent = prefiltered.exponent_of(lobe)
        if exponent is not None:
            for m, here in environments.items():
                mean = emitted.texture(prefiltered.convolved(here, exponent))
                one = one or mean
                curve = emitted.prefiltered_error(library, runtime, chosen, lobe, mean, job.truths[m][label])
                errors.append({"map": m, "lobe": label, "estimator": prefiltered.NAME, **asdict(curve)})
        first = next(iter(maps.values()))
        for e, t in emitted.times(bench, names, chosen, lobe, first, one).items():
            times.append({"lobe": label, "estimator": e, **t.as_data()})
        say("done", what=label)
    return {
        "schema": SCHEMA,
        "device": {"driver_name": job.driver, **described_device(runtime.device)},
        "clock": bench.clock_name,
        "rounds": chosen.rounds,
        "timed_map": next(iter(maps)),
        "errors": errors,
        "times": times,
    }


if __name__ == "__main__":
    serve(lambda text, say: measure(Job.from_json(text), load_library(), say))
