"""The figures of a group in one mode, from the rounds of all visits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from conformance.bench.ratios import Spread, net_ratio, spread
from conformance.bench.steady import Rounds, Steady, steady
from conformance.bench.visits import BASELINE, open_pairs


@dataclass(frozen=True)
class Timing:
    """One member of a group in one mode: nanoseconds per evaluation, and its net time over the base's.

    net_ns, ratio  the median of the visits' medians; quartiles over the rounds of all visits
    by_visit       the ratio that each visit found which timed the member
    """

    net_ns: Spread
    gross_ns: float
    ratio: Spread | None
    by_visit: tuple[float, ...] = ()


@dataclass(frozen=True)
class GroupTiming:
    """A group in one mode.

    members    timings by name
    undecided  pairs of members whose order the visits leave open
    visits     per visit, kernel (the baseline's name is empty) -> nanoseconds per evaluation of every round
    """

    members: dict[str, Timing]
    undecided: list[tuple[str, str]]
    visits: tuple[Rounds, ...]


def timing(visits: Sequence[Rounds], base: str) -> GroupTiming:
    """What the visits say together; the first one timed all members, every one the base and the baseline."""
    level = steady(visits)
    members = {name: _member(level, name, base) for name in level[0] if name != BASELINE}
    net = {name: t.net_ns.median for name, t in members.items()}
    return GroupTiming(members, open_pairs(level, net), tuple(visits))


def _member(visits: Sequence[Steady], name: str, base: str) -> Timing:
    here = [rounds for rounds in visits if name in rounds]
    ratios = [net_ratio(list(r[name]), list(r[base]), list(r[BASELINE])) for r in here]
    reference = [t for r in here for t in r[base]]
    own, floor = ([t for r in here for t in r[key]] for key in (name, BASELINE))
    whole = net_ratio(own, reference, floor)
    above = [float(np.median(r[name] - r[BASELINE])) for r in here]
    found = tuple(r.median for r in ratios if r is not None)
    return Timing(
        _over(above, spread(np.subtract(own, floor).tolist())),
        float(np.median([np.median(r[name]) for r in here])),
        _over(found, whole) if whole is not None and found else None,
        found,
    )


def _over(medians: Sequence[float], rounds: Spread) -> Spread:
    """The median of the visits' medians between the quartiles of all rounds."""
    middle = float(np.median(medians))
    return Spread(middle, min(rounds.low, middle), max(rounds.high, middle))
