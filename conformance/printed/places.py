"""Where a misprint is measured: weighted points, their names, and how they fill a disc of the picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

LAYERS = 16
"""Shells of the example coat."""


LATTICE = 1 << 16
"""Pairs of directions behind a mean over every light."""


@dataclass(frozen=True)
class Places:
    """Points that a misprint is measured at and drawn over.

    points   (N, k)
    weights  (N,), sum 1
    name     index of a point -> where it is, in words
    disc     x and y (M,) of the unit disc -> the points drawn there (M, k)
    """

    points: Array
    weights: Array
    name: Callable[[int], str]
    disc: Callable[[Array, Array], Array]


def direction(polar: float, azimuth: float) -> Array:
    """Unit vector (1, 3) at degrees from z and from x."""
    return _directions(np.array([float(polar)]), np.array([float(azimuth)]))


def hemisphere(polar_step: int, azimuth_step: int) -> tuple[Array, Array, Array]:
    """A grid of whole degrees over the upper hemisphere, zenith and horizon included.

    Each direction is weighted with the solid angle of its cell, exact because the cells tile it.
    returns  directions (N, 3), weights (N,) with sum 1, angles (N, 2) in degrees from z and from x
    """
    polar, azimuth = np.arange(0, 91, polar_step), np.arange(0, 360, azimuth_step)
    low = np.radians(np.maximum(polar - polar_step / 2.0, 0.0))
    high = np.radians(np.minimum(polar + polar_step / 2.0, 90.0))
    angles = np.stack(np.meshgrid(polar, azimuth, indexing="ij"), axis=-1).reshape(-1, 2).astype(np.float64)
    weights = np.repeat((np.cos(low) - np.cos(high)) / len(azimuth), len(azimuth))
    return _directions(angles[:, 0], angles[:, 1]), weights / weights.sum(), angles


def pairs() -> tuple[Array, Array, Array]:
    """Pairs of directions of two hemispheres: an even lattice, and a coarse grid with zenith and horizon.

    The grid weighs nothing: it is there because maxima lie at the ends.
    returns  two arrays of directions (N, 3), weights (N,) with sum 1
    """
    # The lattice of four dimensions whose steps are powers of the root of x^5 = x + 1 (Roberts 2018).
    root = 1.0
    for _ in range(64):
        root = (1.0 + root) ** 0.2
    steps = root ** -np.arange(1.0, 5.0)
    u = (0.5 + np.arange(1, LATTICE + 1)[:, None] * steps) % 1.0
    first, second = (_directions(np.degrees(np.arccos(u[:, k])), 360.0 * u[:, k + 1]) for k in (0, 2))
    coarse, fine = hemisphere(30, 45)[0], hemisphere(15, 15)[0]
    first = np.concatenate([first, np.tile(fine, (len(coarse), 1))])
    second = np.concatenate([second, np.repeat(coarse, len(fine), axis=0)])
    return first, second, np.where(np.arange(len(first)) < LATTICE, 1.0 / LATTICE, 0.0)


def over_hemisphere() -> Places:
    """Every whole degree of the hemisphere about n; drawn in Lambert's projection, n in the middle."""
    points, weights, angles = hemisphere(1, 1)

    def name(index: int) -> str:
        polar, azimuth = angles[index]
        return "0°" if polar == 0.0 else f"{polar:.0f}°, {azimuth:.0f}°"

    def disc(x: Array, y: Array) -> Array:
        square = x * x + y * y
        stretch = np.sqrt(np.maximum(2.0 - square, 0.0))
        return np.stack([x * stretch, y * stretch, np.maximum(1.0 - square, 0.0)], axis=-1)

    return Places(points, weights, name, disc)


def over_layers() -> Places:
    """The shells of a coat as numbers 0 .. LAYERS - 1 (N, 1); drawn as rings, the innermost in the middle."""
    points = np.arange(LAYERS, dtype=np.float64)[:, None]

    def disc(x: Array, y: Array) -> Array:
        return np.asarray(np.minimum(np.floor(np.hypot(x, y) * LAYERS), LAYERS - 1.0)[:, None])

    return Places(points, np.full(LAYERS, 1.0 / LAYERS), lambda index: f"shell {index}", disc)


def ball(x: Array, y: Array) -> Array:
    """Normals (M, 3) of a ball that is seen from z."""
    return np.stack([x, y, np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0))], axis=-1)


def equal_area(w: Array) -> tuple[float, float]:
    """Where Lambert's projection draws the direction (1, 3)."""
    scale = 1.0 / np.sqrt(1.0 + w[0, 2])
    return float(w[0, 0] * scale), float(w[0, 1] * scale)


def _directions(polar: Array, azimuth: Array) -> Array:
    """Unit vectors (N, 3) from degrees; components that are rounding noise are 0."""
    theta, phi = np.radians(polar), np.radians(azimuth)
    w = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    return np.where(np.abs(w) < 1e-15, 0.0, w)
