"""Whether samples follow a density: Pearson's chi-square on the cells of a chart, with Sidak's correction."""

from dataclasses import dataclass

import numpy as np
from scipy import stats

from conformance.statistics.charts import Chart
from conformance.statistics.evaluator import Array
from conformance.statistics.quadrature import Integrand, cell_integrals

SMALLEST_EXPECTATION = 5.0
"""Cells with fewer expected samples are pooled (Cochran's rule)."""


@dataclass(frozen=True)
class ChiSquare:
    """Outcome of one test: statistic, degrees of freedom, probability of a larger statistic, and samples
    used."""

    statistic: float
    degrees: int
    probability: float
    samples: int


def chi_square(samples: Array, pdf: Integrand, chart: Chart, cells: int = 20, nodes: int = 6) -> ChiSquare:
    """Tests directions (N, 3) against a density per steradian."""
    expected = cell_integrals(pdf, chart, cells, cells, nodes).ravel() * len(samples)
    place = np.clip((chart.square(samples) * cells).astype(np.int64), 0, cells - 1)
    observed = np.bincount(place[:, 0] * cells + place[:, 1], minlength=cells * cells).astype(np.float64)
    return pooled_chi_square(observed, expected)


def pooled_chi_square(observed: Array, expected: Array) -> ChiSquare:
    """Pearson's statistic after joining small cells, the smallest first, into cells of enough expectation."""
    order = np.argsort(expected, kind="stable")
    observed, expected = observed[order], expected[order]
    small = int(np.searchsorted(expected, SMALLEST_EXPECTATION))
    bins = np.concatenate([np.floor(np.cumsum(expected[:small]) / SMALLEST_EXPECTATION), np.zeros(0)])
    tail_expected = np.bincount(bins.astype(np.int64), expected[:small], minlength=1)
    tail_observed = np.bincount(bins.astype(np.int64), observed[:small], minlength=1)
    # what is left over below one expectation joins the smallest large cell
    keep = tail_expected >= SMALLEST_EXPECTATION
    rest_expected, rest_observed = tail_expected[~keep].sum(), tail_observed[~keep].sum()
    expected = np.concatenate([expected[small:], tail_expected[keep]])
    observed = np.concatenate([observed[small:], tail_observed[keep]])
    expected[0] += rest_expected
    observed[0] += rest_observed
    statistic = float(np.sum((observed - expected) ** 2 / expected))
    degrees = max(len(expected) - 1, 1)
    return ChiSquare(statistic, degrees, float(stats.chi2.sf(statistic, degrees)), int(observed.sum()))


def sidak_level(family_level: float, tests: int) -> float:
    """Level of a single test so that a family of independent tests errs with probability family_level."""
    return float(-np.expm1(np.log1p(-family_level) / tests))
