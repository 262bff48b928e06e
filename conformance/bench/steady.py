"""Rounds of all visits brought to one level.

What makes every kernel of a round slower says nothing of their order. A processor that clocks higher, or does
less for others, speeds up whole rounds; medians taken of each kernel by itself would then compare the quick
rounds of one with the slow ones of another.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

Rounds = Mapping[str, Sequence[float]]
"""Kernel -> seconds of each round of one visit."""
Steady = dict[str, npt.NDArray[np.float64]]


def steady(visits: Sequence[Rounds]) -> list[Steady]:
    """The rounds of each visit, each divided by its level; the ratios within a round stay what they are.

    visits   the first one holds every kernel, later ones some of them
    returns  times at the median level of all rounds
    """
    usual = {name: float(np.median(times)) or 1.0 for name, times in visits[0].items()}
    levels = [_levels(rounds, usual) for rounds in visits]
    middle = float(np.median(np.concatenate(levels)))
    return [
        {name: np.asarray(times, np.float64) / level * middle for name, times in rounds.items()}
        for rounds, level in zip(visits, levels, strict=True)
    ]


def _levels(rounds: Rounds, usual: Mapping[str, float]) -> npt.NDArray[np.float64]:
    """Per round, how much longer than usual the kernels take: the median over them."""
    shares = [np.asarray(times, np.float64) / usual[name] for name, times in rounds.items()]
    level = np.median(np.asarray(shares), axis=0)
    return np.where(level > 0.0, level, 1.0)
