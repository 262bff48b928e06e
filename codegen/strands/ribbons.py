"""The buffers of strands as ribbons; the vertex stage turns a ribbon to the eye."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.strands.tfx import Doubles

STRAND_VERTEX = np.dtype(
    [
        ("position", "<f4", 3),
        ("along", "<f4", 3),
        ("chord", "<f4", 3),
        ("root", "<f4", 3),
        ("side", "<f4"),
        ("share", "<f4"),
    ]
)
"""Attributes by location.

position  a point of the strand
along     from the point before to the point after; any length, zero too: the stage normalises it
chord     unit, from root to tip: the tangent where the points around coincide
root      unit, how the strand leaves the skin: its normal there
side      -1 or 1, the edge of the ribbon
share     0 at the root and 1 at the tip
"""
UPRIGHT = (0.0, 1.0, 0.0)
"""Direction of strands whose points all coincide."""
SHORTEST = 1.0e-30
"""Lengths below which a difference of two points has no direction, as in safe_normalize."""


@dataclass(frozen=True)
class Ribbons:
    """What a host draws.

    vertices   (V,) of STRAND_VERTEX
    triangles  (F, 3)
    findings   what was found in the strands, counted by name
    """

    vertices: npt.NDArray[Any]
    triangles: npt.NDArray[np.uint32]
    findings: dict[str, int]


def ribbons(points: Doubles) -> Ribbons:
    """The ribbons of strands (strands, points, 3)."""
    strands, each, _ = points.shape
    segments = np.diff(points, axis=1)
    along = np.concatenate([segments[:, :1], points[:, 2:] - points[:, :-2], segments[:, -1:]], axis=1)
    vertices = np.empty((strands, each, 2), STRAND_VERTEX)
    vertices["position"] = points[:, :, None]
    vertices["along"] = along[:, :, None]
    chord = _directions(points[:, -1] - points[:, 0], np.broadcast_to(UPRIGHT, (strands, 3)))
    vertices["chord"] = chord[:, None, None]
    vertices["root"] = _first_direction(segments, chord)[:, None, None]
    vertices["side"] = np.array([-1.0, 1.0])
    vertices["share"] = (np.arange(each) / (each - 1))[:, None]
    first = 2 * np.arange(strands * each, dtype=np.uint32).reshape(strands, each)[:, :-1].reshape(-1, 1)
    triangles = (first + np.array([0, 1, 2, 2, 1, 3], np.uint32)).reshape(-1, 3)
    length = np.linalg.norm(segments, axis=2)
    findings = {
        "strands": strands,
        "points per strand": each,
        "segments without length": int((length < SHORTEST).sum()),
        "strands without length": int((length < SHORTEST).all(axis=1).sum()),
    }
    return Ribbons(vertices.reshape(-1), triangles, findings)


def copied(points: Doubles, copies: int, spread: float, seed: int) -> Doubles:
    """Every strand and copies of it beside it, `copies` in all, up to `spread` away."""
    rng = np.random.default_rng(seed)
    strands, _, _ = points.shape
    away = rng.normal(size=(strands, copies, 3))
    away *= (
        spread * np.cbrt(rng.uniform(size=(strands, copies, 1))) / np.linalg.norm(away, axis=2, keepdims=True)
    )
    away[:, 0] = 0.0
    moved: Doubles = (points[:, None] + away[:, :, None]).reshape(-1, *points.shape[1:])
    return moved


def _directions(x: Doubles, fallback: Doubles) -> Doubles:
    """x (N, 3) over its length, and the fallback where it has none."""
    largest = np.abs(x).max(axis=1, keepdims=True)
    scaled = x / np.where(largest > SHORTEST, largest, 1.0)
    length = np.linalg.norm(scaled, axis=1, keepdims=True)
    unit: Doubles = np.where(largest > SHORTEST, scaled / np.where(length > 0.0, length, 1.0), fallback)
    return unit


def _first_direction(segments: Doubles, fallback: Doubles) -> Doubles:
    """Directions (strands, 3) of the first segments that have a length."""
    has_length = np.abs(segments).max(axis=2) > SHORTEST
    first = has_length.argmax(axis=1)
    return _directions(segments[np.arange(len(segments)), first], fallback)
