"""Lobes on every target: value, density and sampler belong together, and obey physics.

Plan. For each lobe setting of scene_statistics.toml, on the device in float32, at some views, nightly at all:
  integral     the density integrates to 1 over the sphere, by quadrature in a chart of the lobe
  samples      at least 1e6 samples a test follow the density: chi-square, Sidak's correction over all tests
  weights      value l.z / pdf finite and below the documented largest weight, also for the corners of u
  furnace      the estimator meets the albedo of the float64 reference; albedo <= 1 where the model claims it
  reciprocity  value(l, v) = value(v, l)
  agreement    lobe sampling, cosine sampling and their balance heuristic find the same reflected radiance
Seeds are fixed and printed. Left to test_functions: the error of each function against its reference.
"""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Callable, Collection, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.library import load_library
from conformance.reference.lobes import LOBES, REFERENCES
from conformance.statistics.charts import chart_for
from conformance.statistics.chi_square import chi_square, sidak_level
from conformance.statistics.device import device_call, rounded_unit
from conformance.statistics.evaluator import (
    Array,
    Call,
    LobeEvaluator,
    grid_pairs,
    lobe_evaluator,
    reference_call,
    shifted_sets,
    view,
)
from conformance.statistics.furnace import (
    albedo_by_quadrature,
    albedo_by_samples,
    reciprocity_defect,
    weights,
)
from conformance.statistics.quadrature import sphere_integral
from targets import TimedRuntime

CHECKS: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("scene_statistics.toml").read_text(encoding="utf-8")
)["lobes"]
SETTINGS = CHECKS["settings"]
SEED = 20_070_804
COSTLY = ("poulin_fournier",)
"""Lobes whose value is a quadrature."""


def label(row: list[Any]) -> str:
    """Readable name of a setting."""
    return f"{row[0]}({', '.join(f'{x:g}' for x in row[1])})"


def views() -> list[Array]:
    """The views of the table, as float32 numbers."""
    return [rounded_unit(view(polar, azimuth)) for polar, azimuth in CHECKS["views"]]


def some_views(index: int) -> list[int]:
    """Numbers of the views that a setting gets in a normal run; neighbouring settings get others."""
    return [(index + k * CHECKS["view_step"]) % len(CHECKS["views"]) for k in range(CHECKS["few_views"])]


def all_views(index: int) -> list[int]:
    """The numbers of all views."""
    return list(range(len(CHECKS["views"])))


VIEWS = [pytest.param(some_views, id="some"), pytest.param(all_views, id="all", marks=pytest.mark.nightly)]
"""Which views of a setting are tried: index of the setting -> their numbers."""


def lobe(row: list[Any], call: Call) -> LobeEvaluator:
    """The lobe of a setting."""
    return lobe_evaluator(call, row[0], dict(zip(LOBES[row[0]], row[1], strict=True)))


def settings(costly: Collection[str]) -> Iterator[Any]:
    """Numbers of the settings; of a costly lobe only the last in a normal run."""
    last = {row[0]: index for index, row in enumerate(SETTINGS)}
    for index, (name, *_) in enumerate(SETTINGS):
        nightly = name in costly and index != last[name]
        yield pytest.param(index, marks=pytest.mark.nightly) if nightly else index


def on_device(row: list[Any], runtime: TimedRuntime) -> LobeEvaluator:
    """The lobe of a setting on a device."""
    return lobe(row, device_call(load_library(), runtime))


@pytest.mark.parametrize("chosen", VIEWS)
@pytest.mark.parametrize("index", range(len(SETTINGS)), ids=lambda k: label(SETTINGS[k]))
def test_density_integrates_to_one(
    runtime: TimedRuntime, index: int, chosen: Callable[[int], list[int]]
) -> None:
    row = SETTINGS[index]
    evaluator = on_device(row, runtime)
    for v in (views()[k] for k in chosen(index)):
        chart = chart_for(row[0], dict(evaluator.parameters), v)
        total = sphere_integral(evaluator.density(v), chart)
        assert abs(total - 1.0) <= CHECKS["integral"]["tolerance"], (v, total)


def follows(row: list[Any], runtime: TimedRuntime, v: Array, seed: int) -> float:
    """Probability of a worse chi-square than that of the device's samples against its own density."""
    evaluator = on_device(row, runtime)
    samples = evaluator.sample(grid_pairs(CHECKS["chi_square"]["samples"], seed), v)
    outcome = chi_square(samples, evaluator.density(v), chart_for(row[0], dict(evaluator.parameters), v))
    print(f"seed {seed}: {evaluator.name}: chi-square {outcome.statistic:.1f}, {outcome.degrees} degrees, "
          f"p {outcome.probability:.3g}")  # fmt: skip
    return outcome.probability


@pytest.mark.parametrize("index", range(len(SETTINGS)), ids=lambda k: label(SETTINGS[k]))
def test_samples_follow_the_density(runtime: TimedRuntime, index: int) -> None:
    check = CHECKS["chi_square"]
    chosen = check["everyday_views"][index % len(check["everyday_views"])]
    probability = follows(SETTINGS[index], runtime, views()[chosen], SEED + index)
    assert probability >= sidak_level(check["level"], len(SETTINGS))


@pytest.mark.nightly
@pytest.mark.parametrize("index", range(len(SETTINGS)), ids=lambda k: label(SETTINGS[k]))
def test_samples_follow_the_density_for_every_view(runtime: TimedRuntime, index: int) -> None:
    level = sidak_level(CHECKS["chi_square"]["level"], len(SETTINGS) * len(views()))
    for k, v in enumerate(views()):
        assert follows(SETTINGS[index], runtime, v, SEED + 1000 * (k + 1) + index) >= level, v


@pytest.mark.parametrize("chosen", VIEWS)
@pytest.mark.parametrize("index", range(len(SETTINGS)), ids=lambda k: label(SETTINGS[k]))
def test_weights_are_bounded(runtime: TimedRuntime, index: int, chosen: Callable[[int], list[int]]) -> None:
    row = SETTINGS[index]
    evaluator = on_device(row, runtime)
    ends = (0.0, 2.0**-24, 0.25, 0.5, 1.0 - 2.0**-20, 1.0 - 2.0**-24)
    u = np.concatenate([grid_pairs(20_000, SEED), np.array(list(itertools.product(ends, repeat=2)))])
    for v in (views()[k] for k in chosen(index)):
        found, l = weights(evaluator, u, v)
        assert np.isfinite(found).all()
        np.testing.assert_allclose(np.linalg.norm(l, axis=1), 1.0, atol=CHECKS["length"]["tolerance"])
        assert found.max() <= row[2] * (1.0 + CHECKS["weight"]["slack"]), (v, found.max())
        first = evaluator.sample(np.zeros((1, 2)), v)
        assert evaluator.pdf(first, v)[0] > 0.0, "u = (0, 0) must have a density"


@cache
def exact_albedo(index: int, view_index: int) -> float:
    """Albedo of the float64 reference of a setting for a view; computed once for all targets."""
    truth = lobe(SETTINGS[index], reference_call(REFERENCES))
    v = views()[view_index]
    return albedo_by_quadrature(truth, v, chart_for(truth.lobe, dict(truth.parameters), v))


@pytest.mark.parametrize("chosen", VIEWS)
@pytest.mark.parametrize("index", [*settings(COSTLY)], ids=lambda k: label(SETTINGS[k]))
def test_furnace(runtime: TimedRuntime, index: int, chosen: Callable[[int], list[int]]) -> None:
    check, row = CHECKS["furnace"], SETTINGS[index]
    evaluator = on_device(row, runtime)
    for k in chosen(index):
        exact = exact_albedo(index, k)
        found = albedo_by_samples(evaluator, views()[k], SEED, check["count"], check["sets"])
        bias = found.mean - exact
        print(
            f"seed {SEED}: {evaluator.name}: {found.mean:.5f} +- {found.standard_error:.1e}, bias {bias:.1e}"
        )
        scale = max(1.0, exact)
        assert abs(bias) <= check["bias"] * scale
        assert abs(bias) <= check["standard_errors"] * found.standard_error + check["quadrature"] * scale
        if row[3]:
            assert found.mean <= 1.0 + check["claimed"]


@pytest.mark.parametrize("row", SETTINGS, ids=label)
def test_reciprocity(runtime: TimedRuntime, row: list[Any]) -> None:
    check = CHECKS["reciprocity"]
    defect = reciprocity_defect(on_device(row, runtime), SEED, check["pairs"], check["lowest"])
    assert defect <= check["tolerance"], defect


def environment(l: Array) -> Array:
    """A smooth radiance between 0.2 and 1.8."""
    return np.asarray(1.0 + 0.5 * l[:, 0] - 0.3 * l[:, 1] * l[:, 2], dtype=np.float64)


def contributions(
    evaluator: LobeEvaluator, cosine: LobeEvaluator, call: Call, u: Array, v: Array
) -> tuple[float, float, float]:
    """Estimates of the reflected radiance from one point set: by the lobe, by the cosine, by both."""
    count = len(u)
    ones = np.ones(count)
    estimates, shared = [], 0.0
    for own, other in ((evaluator, cosine), (cosine, evaluator)):
        l = own.sample(u, v)
        pdf, rival = own.pdf(l, v), other.pdf(l, v)
        reached = (pdf > 0.0) & (l[:, 2] > 0.0)
        radiance = environment(l) * evaluator.value(l, v) * l[:, 2]
        ratio = np.where(reached, radiance / np.where(reached, pdf, 1.0), 0.0)
        inputs = {"samples_a": ones, "pdf_a": pdf, "samples_b": ones, "pdf_b": rival}
        estimates.append(float(ratio.mean()))
        shared += float((ratio * np.asarray(call("mis_balance", inputs))).mean())
    return estimates[0], estimates[1], shared


@pytest.mark.parametrize("row", CHECKS["agreement"]["settings"], ids=label)
def test_estimators_agree(runtime: TimedRuntime, row: list[Any]) -> None:
    check, call = CHECKS["agreement"], device_call(load_library(), runtime)
    evaluator, cosine = lobe(row, call), lobe(["lambert", []], call)
    v = rounded_unit(view(row[2], row[3]))
    sets = shifted_sets(check["count"], check["sets"], SEED)
    runs = np.array([contributions(evaluator, cosine, call, u, v) for u in sets])
    means, errors = runs.mean(axis=0), runs.std(axis=0, ddof=1) / np.sqrt(len(runs))
    print(f"seed {SEED}: {evaluator.name}: {means} +- {errors}")
    for i, k in itertools.combinations(range(3), 2):
        allowed = check["standard_errors"] * np.hypot(errors[i], errors[k]) + check["floor"]
        assert abs(means[i] - means[k]) <= allowed, (i, k)
