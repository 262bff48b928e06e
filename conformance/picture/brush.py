"""Brushed strands on a surface: a smooth tangent field and the map that makes single strands wobble.

The strands are the curves in which planes orthogonal to one axis cut the surface, as a lathe leaves
them. They have an exact coordinate, the height along the axis, so the wobble of a strand can be a
function of that height that changes quickly across the strands and slowly along them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from conformance.picture.vectors import Floats, unit

SEED = 1994
TABLE = 4096  # knots of the noise, a power of two: numbers wrap with a bit mask
OCTAVES = 3


@dataclass(frozen=True)
class Brush:
    """How a surface is brushed.

    axis       the strands lie in planes orthogonal to it
    amplitude  largest angle between a strand and the smooth field, radians
    frequency  strands per unit of length, of the coarsest octave
    length     length of a strand in widths of a strand
    """

    axis: tuple[float, float, float]
    amplitude: float = 0.0
    frequency: float = 10.0
    length: float = 40.0


def strand_field(axis: npt.ArrayLike, n: Floats) -> Floats:
    """Unit tangents (N, 3) of the strands where the surface has the normals n; any where n = axis."""
    return unit(np.cross(np.asarray(axis, dtype=n.dtype), n))


def strand_map(brush: Brush, position: npt.NDArray[np.float64]) -> Floats:
    """The map of tangents (N, 3) at the positions: unit vectors in the frame (T, B, n), z = 0, float32."""
    across, along = _strand_coordinates(brush, position)
    wobble = np.zeros(len(position))
    for octave in range(OCTAVES):
        wobble += 0.5 ** (octave + 1) * _noise(across * 2.0**octave, along * 2.0**octave, octave)
    angle = brush.amplitude * wobble
    return np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1).astype(np.float32)


def _strand_coordinates(
    brush: Brush, position: npt.NDArray[np.float64]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Which strand, counted along the axis, and where on it, counted in lengths of a strand."""
    axis = unit(np.asarray(brush.axis, dtype=np.float64))
    side = unit(np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    up = np.cross(axis, side)
    across = position @ axis * brush.frequency
    along = (position @ side + position @ up) * brush.frequency / brush.length
    return across, along


def _noise(x: npt.NDArray[np.float64], y: npt.NDArray[np.float64], stream: int) -> npt.NDArray[np.float64]:
    """Value noise in [-1, 1] over the plane, cubic between knots at the integers."""
    random = np.random.default_rng([SEED, stream])
    order, value = random.permutation(TABLE), random.uniform(-1.0, 1.0, TABLE)
    x0, y0 = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    u, v = _ease(x - x0), _ease(y - y0)

    def knot(i: npt.NDArray[np.int64], j: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
        row: npt.NDArray[np.int64] = order[j & (TABLE - 1)]
        found: npt.NDArray[np.float64] = value[order[(i + row) & (TABLE - 1)]]
        return found

    low = (1.0 - u) * knot(x0, y0) + u * knot(x0 + 1, y0)
    high = (1.0 - u) * knot(x0, y0 + 1) + u * knot(x0 + 1, y0 + 1)
    noise: npt.NDArray[np.float64] = (1.0 - v) * low + v * high
    return noise


def _ease(x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    eased: npt.NDArray[np.float64] = x * x * (3.0 - 2.0 * x)
    return eased
