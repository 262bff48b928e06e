"""Pareto fronts: what is not beaten in both cost and error."""

from __future__ import annotations

from collections.abc import Mapping

Point = tuple[float, float]
"""Cost and error; less is better."""


def dominates(a: Point, b: Point) -> bool:
    """Whether a is at least as good as b in both, and better in one."""
    return a[0] <= b[0] and a[1] <= b[1] and a != b


def front(points: Mapping[str, Point]) -> list[str]:
    """The names of the points that no other dominates, cheapest first; equal points are all on it."""
    kept = [name for name, p in points.items() if not any(dominates(q, p) for q in points.values())]
    return sorted(kept, key=lambda name: (points[name], name))
