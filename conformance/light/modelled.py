"""The estimators in float64: errors against quadrature by map, lobe, estimator and number of samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from codegen.maps.radiance import read_radiance
from conformance.light import estimators, plan, prefiltered
from conformance.light.environment import Environment, MapSampler
from conformance.light.estimators import Samples
from conformance.light.lobes import Lobe
from conformance.light.plan import Plan

Array = npt.NDArray[np.float64]

HOST_SIDE = "combined"
"""Samples of lobe and map together: the map's distribution is made on the host."""
BIAS = "bias"
"""What remains of the filtered estimator's error when it is averaged over AVERAGED shifts of the points."""
AVERAGED = 16


@dataclass(frozen=True)
class Curve:
    """Errors of one estimator: numbers of samples and relative root mean squares, as many."""

    samples: tuple[int, ...]
    rms: tuple[float, ...]


def environments(chosen: Plan) -> dict[str, Environment]:
    """The maps of a plan with their chains weighted by solid angle, as `vair env` writes them."""
    found = {}
    for name in chosen.maps:
        found[name] = Environment(read_radiance(plan.path_of(name), clean=True), weighted=True)
    return found


def truths(chosen: Plan, lobe: Lobe, maps: Mapping[str, Environment]) -> dict[str, Array]:
    """Quadrature over every texel at every place, (views, 3) by map. The maps are of one size."""
    view, first = plan.frames(chosen), next(iter(maps.values()))
    energy = np.concatenate([here.energy for here in maps.values()], axis=1)
    rows = [lobe.value(view.to_local(k, first.directions), view.v[k]) @ energy for k in range(len(view))]
    parts = np.split(np.stack(rows), len(maps), axis=1)
    return dict(zip(maps, parts, strict=True))


@dataclass(frozen=True)
class Drawn:
    """A lobe's samples, which serve every map: by their number, half as many, with many shifts; the peak."""

    whole: dict[int, Samples]
    half: dict[int, Samples]
    shifted: dict[int, Samples]
    peak: Samples


def drawn(chosen: Plan, lobe: Lobe) -> Drawn:
    """The samples of a plan."""
    view, many = plan.repeated(chosen), replace(chosen, shifts=AVERAGED)
    whole = {n: estimators.drawn(view, lobe, plan.points(chosen, n)) for n in chosen.counts}
    half = {
        n: whole.get(n // 2) or estimators.drawn(view, lobe, plan.points(chosen, n // 2))
        for n in chosen.counts
    }
    # Of so many samples that fewer shifts than samples are averaged, and the noise of the mean is small.
    few = [n for n in chosen.counts if n <= max(chosen.counts) // 8]
    shifted = {n: estimators.drawn(plan.repeated(many), lobe, plan.points(many, n)) for n in few}
    return Drawn(whole, half, shifted, estimators.peak(view, lobe))


def curves(
    chosen: Plan, lobe: Lobe, here: Environment, sampler: MapSampler, truth: Array, samples: Drawn
) -> dict[str, Curve]:
    """Every estimator's errors in float64.

    truth  (views, 3), as truths gives them
    """
    view, right = plan.repeated(chosen), np.repeat(truth, chosen.shifts, axis=0)

    def combined(n: int) -> Array:
        _, others = estimators.halves(n)
        return estimators.together(here, view, lobe, samples.half[n], others, sampler)

    ways: dict[str, Callable[[int, Samples], Array]] = {
        "monte_carlo": lambda n, s: estimators.mean(here, s),
        "filtered": lambda n, s: estimators.mean(here, s, estimators.levels(here, s, n)),
        "guarded": lambda n, s: estimators.mean(here, s, estimators.guarded_levels(here, s, samples.peak)),
        HOST_SIDE: lambda n, s: combined(n),
    }
    found = {"grid": _grid(chosen, lobe, here, truth)}
    for name, estimate in ways.items():
        errors = [estimators.rms(estimate(n, s), right) for n, s in samples.whole.items()]
        found[name] = Curve(chosen.counts, tuple(errors))
    found[BIAS] = _bias(chosen, here, truth, samples)
    exponent = prefiltered.exponent_of(lobe)
    if exponent is not None:
        found[prefiltered.NAME] = _prefiltered(chosen, lobe, prefiltered.convolved(here, exponent), truth)
    return found


def _bias(chosen: Plan, here: Environment, truth: Array, samples: Drawn) -> Curve:
    """The error of the mean over many shifts of the filtered estimator's points."""
    errors = []
    for n, s in samples.shifted.items():
        estimate = estimators.mean(here, s, estimators.levels(here, s, n))
        errors.append(estimators.rms(estimate.reshape(chosen.views, AVERAGED, 3).mean(axis=1), truth))
    return Curve(tuple(samples.shifted), tuple(errors))


def _prefiltered(chosen: Plan, lobe: Lobe, convolved: Environment, truth: Array) -> Curve:
    view = plan.frames(chosen)
    estimate = convolved.radiance(prefiltered.directions(view, lobe)) * prefiltered.scale(view, lobe)
    return Curve((1,), (estimators.rms(estimate, truth),))


def _grid(chosen: Plan, lobe: Lobe, here: Environment, truth: Array) -> Curve:
    """Grids of a power of two of rows and twice as many columns, not turned by the shifts."""
    view = plan.frames(chosen)
    rows = [2**k for k in range(1, 8) if min(chosen.counts) <= 2 * 4**k <= max(chosen.counts)]
    errors = [estimators.rms(estimators.grid(here, view, lobe, r), truth) for r in rows]
    return Curve(tuple(2 * r * r for r in rows), tuple(errors))
