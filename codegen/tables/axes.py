"""Axes of a table: how an argument becomes a coordinate in [0, 1]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Axis:
    """One argument over [low, high], laid out by a warp.

    linear  evenly
    angle   by the arc sine, for cosines in [-1, 1]: square roots at the ends become straight lines
    root    by the square root, for arguments from 0: dense near 0
    log     by the logarithm, for arguments above 0
    """

    name: str
    low: float
    high: float
    warp: str = "linear"

    def coordinate(self, value: Array) -> Array:
        """Coordinates in [0, 1] of arguments, clamped to the axis."""
        place = _forward(self.warp, np.clip(value, self.low, self.high))
        low, high = (float(_forward(self.warp, np.array(x))) for x in (self.low, self.high))
        return np.asarray(np.clip((place - low) / (high - low), 0.0, 1.0))

    def value(self, coordinate: Array) -> Array:
        """Arguments at coordinates in [0, 1]."""
        low, high = (float(_forward(self.warp, np.array(x))) for x in (self.low, self.high))
        return np.asarray(np.clip(_backward(self.warp, low + (high - low) * coordinate), self.low, self.high))

    def warps(self) -> list[str]:
        """The warps that fit the interval, the simplest first."""
        found = ["linear"]
        if self.low >= -1.0 and self.high <= 1.0:
            found.append("angle")
        if self.low >= 0.0:
            found.append("root")
        if self.low > 0.0:
            found.append("log")
        return found


def _forward(warp: str, x: Array) -> Array:
    match warp:
        case "angle":
            return np.asarray(np.arcsin(x) / np.pi + 0.5)
        case "root":
            return np.sqrt(x)
        case "log":
            return np.log(x)
        case _:
            return x


def _backward(warp: str, y: Array) -> Array:
    match warp:
        case "angle":
            return np.asarray(np.sin(np.pi * (y - 0.5)))
        case "root":
            return y * y
        case "log":
            return np.exp(y)
        case _:
            return y
