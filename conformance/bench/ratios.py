"""Medians and quartiles of what the rounds of a measurement found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

SMALLEST_SHARE = 0.02
"""A net time below this share of the whole time is lost in its noise: no ratio is formed with it."""


@dataclass(frozen=True)
class Spread:
    """Median and quartiles."""

    median: float
    low: float
    high: float


def spread(values: Sequence[float]) -> Spread:
    """Median and quartiles of at least one value."""
    low, median, high = np.quantile(np.asarray(values, np.float64), (0.25, 0.5, 0.75))
    return Spread(float(median), float(low), float(high))


def net(times: Sequence[float], baseline: Sequence[float]) -> list[float]:
    """Round by round, the time above the baseline kernel's."""
    return [t - b for t, b in zip(times, baseline, strict=True)]


def net_ratio(times: Sequence[float], reference: Sequence[float], baseline: Sequence[float]) -> Spread | None:
    """Net time of one kernel over that of another, formed per round so that slow drifts cancel.

    times, reference, baseline  seconds of each round, measured in the same rounds
    returns                     None where the reference's net time is lost in the noise
    """
    below = net(reference, baseline)
    if np.median(below) < SMALLEST_SHARE * np.median(np.asarray(reference)):
        return None
    quotients = [a / b for a, b in zip(net(times, baseline), below, strict=True) if b > 0.0]
    return spread(quotients)


def straightness(steps: Sequence[int], times: Sequence[float]) -> float:
    """How straight the line of time against steps is: its middle point over the chord there; 1 is straight.

    steps, times  three points in order
    """
    (a, b, c), (x, y, z) = steps, times
    chord = x + (z - x) * (b - a) / (c - a)
    return y / chord
