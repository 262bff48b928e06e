"""When a measurement may stop: as soon as the order of every two members is known.

Two members are ordered once the confidence interval of the median of their rounds' differences leaves out 0.
They are alike once it lies within half of CLOSE of the smaller net time. Else they are undecided, and more
rounds are worth their time.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.stats import binom

Verdict = Literal["first", "second", "alike", "undecided"]

CLOSE = 0.05
"""Members whose net times differ by more than this share must come in the same order in every run."""
CONFIDENCE = 0.99
"""Of the interval that decides one pair."""


def median_interval(values: Sequence[float] | npt.NDArray[np.float64]) -> tuple[float, float]:
    """The confidence interval of the median by order statistics, which asks nothing of the distribution.

    returns  infinite ends where there are too few values
    """
    ordered = np.sort(np.asarray(values, np.float64))
    rank = _rank(len(ordered))
    if rank < 1:
        return -np.inf, np.inf
    return float(ordered[rank - 1]), float(ordered[-rank])


@functools.cache
def _rank(count: int) -> int:
    """So many values from either end lies the interval's end; 0: nowhere."""
    return int(binom.ppf((1.0 - CONFIDENCE) / 2.0, count, 0.5))


def compare(first: Sequence[float], second: Sequence[float], baseline: Sequence[float]) -> Verdict:
    """Which of two members is faster.

    first, second, baseline  seconds of the same rounds
    """
    a, b, floor = (np.asarray(v, np.float64) for v in (first, second, baseline))
    low, high = median_interval(a - b)
    smaller = max(min(float(np.median(a - floor)), float(np.median(b - floor))), 0.0)
    within = CLOSE / 2.0 * smaller
    if -within <= low and high <= within:
        return "alike"
    if high < 0.0:
        return "first"
    return "second" if low > 0.0 else "undecided"


def undecided(times: Mapping[str, Sequence[float]], baseline: str) -> list[tuple[str, str]]:
    """The pairs of members whose order the rounds leave open.

    times     kernel -> seconds of its rounds
    baseline  the kernel among them that does nothing but add up the inputs
    """
    floor = times[baseline]
    members = [name for name in times if name != baseline]
    return [(a, b) for a, b in combinations(members, 2) if compare(times[a], times[b], floor) == "undecided"]


def settled(times: Mapping[str, Sequence[float]], baseline: str) -> bool:
    """Whether no pair is left open."""
    return not undecided(times, baseline)
