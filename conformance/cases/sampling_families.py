"""Families for sampling: sums that wrap, creases and rim of the concentric map, ends of the square."""

from __future__ import annotations

import itertools

import numpy as np

from conformance.cases.family import Family, Points, Role
from conformance.cases.stream import Stream, single

GRID = 2.0**-24


def shifted_pairs(stream: Stream) -> Points:
    """u + shift on the grid k 2^-24, next to 1 from both sides, and at the ends."""
    first = np.array([0.0, GRID, 0.25, 1.0 / 3.0, 0.5, 0.75, 1.0 - 2.0 * GRID, 1.0 - GRID])
    first = np.concatenate([np.floor(first / GRID) * GRID, np.floor(stream.uniform(22) / GRID) * GRID])
    rows = []
    for u, k in itertools.product(first, range(-4, 5)):
        wrapped = min(max(1.0 - u + k * GRID, 0.0), 1.0 - GRID)
        rows.append((u, first[k % len(first)], wrapped, first[(3 * k) % len(first)]))
    table = np.array(rows)
    return {"u": single(table[:, :2]), "shift": single(table[:, 2:])}


def disc_creases(stream: Stream) -> Points:
    """|2u.x - 1| = |2u.y - 1| and next to it, from the centre to the rim; the axes of the disc."""
    radii = [0.0, GRID, 1e-6, 1e-3, 0.1, 0.25, 0.3, 0.49, 0.5 - GRID]
    rows: list[tuple[float, float]] = []
    for r, (sx, sy), k in itertools.product(radii, ((1, 1), (1, -1), (-1, 1), (-1, -1)), (-2, -1, 0, 1, 2)):
        rows += [(0.5 + sx * r, 0.5 + sy * r + k * GRID)]
    rows += [(0.5 + s * r, 0.5 + k * GRID) for r in radii for s in (1, -1) for k in (-1, 0, 1)]
    rows += [(0.5 + k * GRID, 0.5 + s * r) for r in radii for s in (1, -1) for k in (-1, 0, 1)]
    return {"u": single(np.clip(np.array(rows), 0.0, 1.0 - GRID))}


FAMILIES: tuple[Family, ...] = (
    Family(
        "shifted_pairs",
        (Role("u", "vec2", False, "^u$"), Role("shift", "vec2", False, "^shift$")),
        "sums within 4 steps of 1, on the grid of 2^-24",
        "the sum of two 24-bit fractions has 25 bits",
        shifted_pairs,
    ),
    Family(
        "disc_creases",
        (Role("u", "vec2", False, "^u$"),),
        "diagonals and axes of the square, centre and rim",
        "the concentric map divides the smaller by the larger; 0/0 in the centre",
        disc_creases,
    ),
)
