"""Albedo in a white furnace, by quadrature of the value and by the estimator value l.z / pdf."""

from dataclasses import dataclass

import numpy as np

from conformance.statistics.charts import Chart
from conformance.statistics.evaluator import Array, LobeEvaluator, shifted_sets
from conformance.statistics.quadrature import sphere_integral


@dataclass(frozen=True)
class Estimate:
    """A mean, its standard error from independent replications, and extremes of the summed weights."""

    mean: float
    standard_error: float
    largest: float
    below: float


def albedo_by_quadrature(lobe: LobeEvaluator, v: Array, chart: Chart, cells: int = 40) -> float:
    """Integral of value max(l.z, 0) over the sphere."""
    return sphere_integral(lambda l: lobe.value(l, v) * np.maximum(l[:, 2], 0.0), chart, cells)


def weights(lobe: LobeEvaluator, u: Array, v: Array) -> tuple[Array, Array]:
    """value l.z / pdf of the samples, 0 below the horizon or where pdf is 0; and their directions."""
    l = lobe.sample(u, v)
    value, pdf = lobe.value(l, v), lobe.pdf(l, v)
    counts = (pdf > 0.0) & (l[:, 2] > 0.0)
    return np.where(counts, value * l[:, 2] / np.where(counts, pdf, 1.0), 0.0), l


def albedo_by_samples(
    lobe: LobeEvaluator, v: Array, seed: int, count: int = 65536, sets: int = 8
) -> Estimate:
    """The estimator of the lecture in a furnace of radiance 1; standard error between point sets."""
    means, largest, below = [], 0.0, 0.0
    for u in shifted_sets(count, sets, seed):
        w, l = weights(lobe, u, v)
        means.append(float(w.mean()))
        largest = max(largest, float(w.max()))
        below += float(np.mean(l[:, 2] <= 0.0)) / sets
    spread = float(np.std(means, ddof=1) / np.sqrt(sets))
    return Estimate(float(np.mean(means)), spread, largest, below)


def reciprocity_defect(lobe: LobeEvaluator, seed: int, count: int = 20000, lowest: float = 0.02) -> float:
    """Largest |f(l, v) - f(v, l)| / max over random pairs of directions above `lowest`."""
    random = np.random.Generator(np.random.Philox(seed))
    z = random.uniform(lowest, 1.0, (2, count))
    phi = random.uniform(0.0, 2.0 * np.pi, (2, count))
    s = np.sqrt(1.0 - z * z)
    first, second = np.stack([s * np.cos(phi), s * np.sin(phi), z], axis=-1)
    there, back = lobe.value(first, second), lobe.value(second, first)
    scale = np.maximum(np.maximum(there, back), 1e-6 * max(float(there.max()), 1e-30))
    return float(np.max(np.abs(there - back) / scale))
