"""Integrals over the sphere through a chart: totals, and the share of every cell of a grid."""

from collections.abc import Callable

import numpy as np

from conformance.statistics.charts import Chart
from conformance.statistics.evaluator import Array

Integrand = Callable[[Array], Array]
"""Directions (N, 3) -> values (N,)."""


def cell_integrals(integrand: Integrand, chart: Chart, rows: int, columns: int, nodes: int) -> Array:
    """Integral over each of rows x columns cells of the square, by nodes x nodes Gauss points in each."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    first = ((np.arange(rows)[:, None] + (x + 1.0) / 2.0) / rows).ravel()
    second = ((np.arange(columns)[:, None] + (x + 1.0) / 2.0) / columns).ravel()
    points = np.stack(np.meshgrid(first, second, indexing="ij"), axis=-1).reshape(-1, 2)
    direction, area = chart.direction(points)
    values = (integrand(direction) * area).reshape(rows, nodes, columns, nodes)
    cells = np.einsum("inkm,n,m->ik", values, w / 2.0, w / 2.0) / (rows * columns)
    return np.asarray(cells, dtype=np.float64)


def sphere_integral(integrand: Integrand, chart: Chart, cells: int = 40, nodes: int = 6) -> float:
    """Integral over the sphere."""
    return float(cell_integrals(integrand, chart, cells, cells, nodes).sum())
