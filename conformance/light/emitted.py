"""The emitted estimators on a driver: their errors against quadrature, and their time per shaded point."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate.arrays import arithmetic, convert_inputs
from codegen.evaluate.textures import TextureMap
from codegen.execute import execute, on_device
from codegen.ir.types import leaves
from codegen.kernels import kernel
from codegen.library import Library
from conformance.bench.ratios import Spread, spread
from conformance.bench.record import quartiles
from conformance.bench.timing import Bench
from conformance.light import estimators, plan, prefiltered
from conformance.light.environment import Environment
from conformance.light.lobes import Lobe
from conformance.light.modelled import Curve
from conformance.light.plan import Plan
from targets import TimedRuntime
from targets.protocol import Prepared

Array = npt.NDArray[np.float64]

BY_LOBE = ("grid", "monte_carlo", "filtered", "guarded")
"""Estimators of which the library has one function for every lobe."""
PREFILTERED = "env_prefiltered"
LEAST_LANES = 32
SAMPLES_A_LAUNCH = 1 << 15
"""Of a software driver, at least: some milliseconds."""
HARDWARE_LANES = 1 << 16


@dataclass(frozen=True)
class Times:
    """Nanoseconds per shaded point: numbers of samples, and a median with quartiles for each."""

    samples: tuple[int, ...]
    ns: tuple[Spread, ...]

    def as_data(self) -> dict[str, Any]:
        """Medians and quartiles, as results hold them."""
        return {
            "samples": list(self.samples),
            "ns": [s.median for s in self.ns],
            "quartiles": [quartiles(s) for s in self.ns],
        }


def function_of(estimator: str, lobe: Lobe) -> str:
    """The library's name of an estimator of a lobe."""
    return f"env_{estimator}_{lobe.name}"


def texture(here: Environment) -> TextureMap:
    """The map as `vair env` writes it: the front disc left, the back disc right, opaque."""
    levels = []
    for pair in here.levels:
        level = np.concatenate(list(pair), axis=1)
        levels.append(np.concatenate([level, np.ones((*level.shape[:2], 1))], axis=2).astype(np.float32))
    return TextureMap(tuple(levels))


def arguments(
    library: Library, name: str, chosen: Plan, lobe: Lobe, counts: Sequence[int], env: TextureMap
) -> dict[str, Any]:
    """Inputs of an estimator: all places with the first number of samples, then with the next."""
    view, moved = plan.repeated(chosen), plan.shifts(chosen)
    places = {
        "frame": {"tangent": view.tangent, "bitangent": view.bitangent, "normal": view.normal},
        "v": view.to_world(view.v[:, None, :])[:, 0],
        "shift": moved,
    }
    given: dict[str, Any] = {
        "env": env,
        "samples": np.repeat(np.asarray(counts, np.uint32), len(view)),
        **{key: _tiled(value, len(counts)) for key, value in places.items()},
    }
    names = [p.name for p in library.function(name).parameters if p.name not in given]
    held = {key: np.array([x]) for key, x in zip(names, lobe.parameters, strict=True)}
    return given | held


def _tiled(value: Any, times: int) -> Any:
    if isinstance(value, Mapping):
        return {key: _tiled(part, times) for key, part in value.items()}
    return np.tile(value, (times, 1)).astype(np.float32)


def errors(
    library: Library,
    runtime: TimedRuntime,
    estimator: str,
    chosen: Plan,
    lobe: Lobe,
    env: TextureMap,
    truth: Array,
) -> Curve:
    """An estimator's errors as the driver computes it; infinite where a result is not finite.

    truth  (views, 3)
    """
    name = function_of(estimator, lobe)
    got = execute(library, name, arguments(library, name, chosen, lobe, chosen.counts, env), runtime)
    found = np.asarray(got, np.float64).reshape(len(chosen.counts), -1, 3)
    right = np.repeat(truth, chosen.shifts, axis=0)
    rms = [estimators.rms(part, right) if np.isfinite(part).all() else math.inf for part in found]
    return Curve(chosen.counts, tuple(rms))


def prefiltered_error(
    library: Library, runtime: TimedRuntime, chosen: Plan, lobe: Lobe, convolved: TextureMap, truth: Array
) -> Curve:
    """The error of one lookup as the driver makes it; the factor of the lobe is multiplied here."""
    view = plan.frames(chosen)
    given = {"env": convolved, "w": prefiltered.directions(view, lobe)}
    got = np.asarray(execute(library, PREFILTERED, given, runtime), np.float64)
    return Curve((1,), (estimators.rms(got * prefiltered.scale(view, lobe), truth),))


def times(
    bench: Bench,
    names: Mapping[str, str],
    chosen: Plan,
    lobe: Lobe,
    env: TextureMap,
    convolved: TextureMap | None = None,
) -> dict[str, Times]:
    """The time of estimators of one lobe with the timed numbers of samples, all of them interleaved.

    names      estimator -> function
    convolved  the map of the one lookup in a prefiltered map, where there is one
    """
    calls = {
        (estimator, count): (name, arguments(bench.library, name, chosen, lobe, (count,), env))
        for estimator, name in names.items()
        for count in chosen.timed
    }
    if convolved is not None:
        given = {"env": convolved, "w": prefiltered.directions(plan.frames(chosen), lobe)}
        calls[prefiltered.NAME, 1] = PREFILTERED, given
    ready, lanes = {}, {}
    try:
        for (estimator, count), (name, given) in calls.items():
            key = f"{estimator} {count}"
            lanes[key] = max(SAMPLES_A_LAUNCH // count, LEAST_LANES) if bench.software else HARDWARE_LANES
            ready[key] = _prepared(bench, name, given, lanes[key])
        rounds = bench.rounds(ready)
    finally:
        for one in ready.values():
            one.release()
    spreads = {
        key: spread([(t / 2.0 - bench.empty) / lanes[key] * 1e9 for t in taken])
        for key, taken in rounds.items()
    }
    found = {}
    for estimator in dict.fromkeys(estimator for estimator, _ in calls):
        counts = tuple(count for e, count in calls if e == estimator)
        found[estimator] = Times(counts, tuple(spreads[f"{estimator} {count}"] for count in counts))
    return found


def _prepared(bench: Bench, name: str, given: Mapping[str, Any], lanes: int) -> Prepared:
    """A call on the device, its inputs repeated over so many lanes."""
    function = bench.library.function(name)
    types = {p.name: p.type for p in function.parameters}
    arrays, n = convert_inputs(types, given, arithmetic("float32"), name)
    words, maps = on_device(function, arrays, n)
    words = np.ascontiguousarray(np.resize(words.T, (lanes, len(words))).T)
    program = kernel(bench.library, name, bench.runtime.device.target)
    return bench.runtime.prepare(program, words, len(leaves(function.returns)), maps)
