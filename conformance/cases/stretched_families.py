"""Directions that are not quite unit: outside every domain, so never drawn, but loaded by name."""

from __future__ import annotations

import numpy as np

from conformance.cases.family import Family, Points, Role
from conformance.cases.stream import LADDER, Stream, single, tilted

LENGTHS = (1e-3, -1e-3, 1e-4, -1e-4, 1e-5, -1e-5, 0.0)
NOTHING = "(?!)"
"""A pattern that no name matches."""


def stretched_directions(stream: Stream) -> Points:
    """Four directions in general position or nearly parallel, each with its own length 1 +- 1e-3 .. 1e-5."""
    n = 280
    a = stream.anchors(n)
    near = (np.arange(n) % 4 == 0)[:, None]
    turn = np.array(LADDER)[np.arange(n) % len(LADDER)]
    directions = {"a": a, "b": np.where(near, tilted(a, stream.across(a), turn), stream.directions(n))}
    directions |= {"c": stream.directions(n), "d": stream.directions(n)}
    lengths = 1.0 + np.array(LENGTHS)[stream.below(4 * n, len(LENGTHS))].reshape(4, n)
    return {name: single(x * lengths[k][:, None]) for k, (name, x) in enumerate(directions.items())}


FAMILIES: tuple[Family, ...] = (
    Family(
        "stretched_directions",
        tuple(Role(name, "vec3", False, NOTHING) for name in "abcd"),
        "four directions of length 1 +- 1e-3, 1e-4, 1e-5 or 1",
        "interpolated and filtered normals and tangents are not unit; the error may grow in proportion only",
        stretched_directions,
    ),
)
