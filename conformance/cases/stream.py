"""Random numbers and elementary geometry whose bits do not depend on the machine.

Only the raw output of PCG64 is used (NumPy guarantees its stream) and only + - * / sqrt, which IEEE 754
rounds correctly everywhere; sines and cosines of a turn come from the tangent of half the turn.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

F32 = npt.NDArray[np.float32]
F64 = npt.NDArray[np.float64]

SMALLEST_NORMAL = 2.0**-126

LADDER: tuple[float, ...] = tuple(float(f"{m}e-{k}") for k in range(1, 8) for m in ("1", "2.2", "4.7"))
"""Small angles in radians, three per decade from 4.7e-1 to 1e-7."""

AXES: F64 = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=np.float64)


class Stream:
    """A stream of random numbers named by a few integers."""

    def __init__(self, *name: int) -> None:
        self.bits = np.random.PCG64(np.random.SeedSequence(list(name)))

    def words(self, n: int) -> npt.NDArray[np.uint32]:
        """n uniform 32-bit words."""
        return (self.bits.random_raw(n) >> np.uint64(32)).astype(np.uint32)

    def uniform(self, n: int, low: float = 0.0, high: float = 1.0) -> F64:
        """n numbers in [low, high)."""
        unit = (self.bits.random_raw(n) >> np.uint64(11)).astype(np.float64) * 2.0**-53
        return low + unit * (high - low)

    def below(self, n: int, limit: int) -> npt.NDArray[np.intp]:
        """n indices in [0, limit)."""
        return np.minimum((self.uniform(n) * limit).astype(np.intp), limit - 1)

    def permutation(self, n: int) -> npt.NDArray[np.intp]:
        """The numbers 0 .. n - 1 in random order."""
        return np.argsort(self.bits.random_raw(n), kind="stable")

    def directions(self, n: int) -> F64:
        """n unit vectors, uniform on the sphere: points of the cube that lie in the ball, projected."""
        found = np.empty((0, 3))
        while len(found) < n:
            points = self.uniform(6 * (n + 8), -1.0, 1.0).reshape(-1, 3)
            size = norm(points)
            found = np.concatenate([found, points[(size < 1.0) & (size > 1e-3)]])
        return normalised(found[:n])

    def anchors(self, n: int) -> F64:
        """n unit vectors; every third one is a coordinate axis, in turn."""
        vectors = self.directions(n)
        rows = np.arange(0, n, 3)
        vectors[rows] = AXES[np.arange(len(rows)) % len(AXES)]
        return vectors

    def across(self, x: F64) -> F64:
        """For each unit vector a random unit vector orthogonal to it."""
        y = self.directions(len(x))
        return normalised(np.cross(x, np.where(norm(np.cross(x, y))[:, None] > 1e-2, y, y[:, [1, 2, 0]])))


def norm(x: F64) -> F64:
    """Euclidean length, summed in a fixed order."""
    return np.asarray(np.sqrt(x[..., 0] * x[..., 0] + x[..., 1] * x[..., 1] + x[..., 2] * x[..., 2]))


def normalised(x: F64) -> F64:
    """Unit vectors in float64."""
    return np.asarray(x / norm(x)[..., None])


def tilted(x: F64, toward: F64, turn: npt.ArrayLike) -> F64:
    """x turned by 2 atan(turn / 2) radians, which is `turn` for a small turn, toward an orthogonal vector."""
    half = np.broadcast_to(np.asarray(turn, dtype=np.float64) / 2.0, (len(x),))[:, None]
    square = half * half
    return np.asarray((x * (1.0 - square) + toward * (2.0 * half)) / (1.0 + square))


def single(x: npt.ArrayLike) -> F32:
    """Rounded to float32, denormals to zero."""
    rounded = np.asarray(x, dtype=np.float64)
    rounded = np.where(np.abs(rounded) < SMALLEST_NORMAL, rounded * 0.0, rounded)
    return rounded.astype(np.float32)


def normalised_single(x: npt.ArrayLike) -> F32:
    """Unit vectors as a program in float32 gets them: every operation rounded to float32."""
    y = np.asarray(x, dtype=np.float32)
    size = np.sqrt(y[:, 0] * y[:, 0] + y[:, 1] * y[:, 1] + y[:, 2] * y[:, 2])
    return np.asarray(y / size[:, None], dtype=np.float32)


def neighbour(x: npt.ArrayLike, steps: npt.ArrayLike) -> F32:
    """The float32 number that many ULPs further; a step off zero leads to +-1e-30, which is no denormal."""
    y = np.array(x, dtype=np.float32, ndmin=1)
    offsets = np.broadcast_to(np.asarray(steps, dtype=np.int32), y.shape)
    words = y.view(np.int32)
    moved = np.where(y >= 0.0, words + offsets, words - offsets).astype(np.int32).view(np.float32)
    off_zero = np.sign(offsets).astype(np.float32) * np.float32(1e-30)
    return np.where(y == 0.0, np.where(offsets == 0, y, off_zero), moved)
