"""Which of two members is faster, told from several visits: each times them in a process of its own.

Within one process the rounds agree with each other far better than two processes do: where a driver puts code
and data, and what else the processor does meanwhile, shifts all of them alike. So an order counts as
decided only where visits that know nothing of each other say the same.

Every visit votes for the member that its own rounds put first, or for none. A member that leads by three
votes is faster, if the visits' median difference exceeds half of CLOSE; a lead of two suffices above CLEAR
where none is against it. A single visit decides nothing below FAR.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from conformance.bench.steady import Steady
from conformance.bench.stopping import CLOSE, Verdict, median_interval

FAR = 0.25
"""Of 382 pairs on three software drivers, 99 in 100 differed by less than this between two single visits."""
CLEAR = 0.10
"""And nine in ten by less than this: two visits that both say more hardly agree by chance."""
LEAST_VISITS = 2
LEAD = 3
"""Votes that one member needs more than the other."""
MOST_VISITS = 5
BASELINE = ""
"""Key of the kernel that does nothing but add up the inputs."""


@dataclass(frozen=True)
class Seen:
    """What one visit saw of a pair: first less second as a share of the smaller net time.

    middle     median over the rounds
    low, high  its confidence interval
    """

    middle: float
    low: float
    high: float

    @property
    def vote(self) -> Verdict:
        """Which is faster by this visit alone."""
        if max(-self.low, self.high) <= CLOSE / 2.0:
            return "alike"
        if self.high < 0.0:
            return "first"
        return "second" if self.low > 0.0 else "undecided"


def seen(visits: Sequence[Steady], first: str, second: str) -> list[Seen]:
    """What each visit saw that timed both members."""
    found = []
    for rounds in visits:
        if first not in rounds or second not in rounds:
            continue
        a, b, floor = rounds[first], rounds[second], rounds[BASELINE]
        smaller = min(float(np.median(a - floor)), float(np.median(b - floor)))
        # Where a net time is lost in the noise, a hundredth of the whole time stands for it.
        smaller = max(smaller, 0.01 * float(np.median(np.minimum(a, b))))
        low, high = median_interval(a - b)
        found.append(Seen(float(np.median(a - b)) / smaller, low / smaller, high / smaller))
    return found


def joined(pair: Sequence[Seen]) -> Verdict:
    """The verdict of all visits on a pair."""
    count, lead, middle = len(pair), _lead(pair), _middle(pair)
    if (
        abs(lead) >= needed(pair)
        and abs(middle) > (CLOSE / 2.0 if count > 1 else FAR)
        and lead * middle < 0.0
    ):
        return "first" if lead > 0 else "second"
    alike = [s.vote for s in pair].count("alike")
    # Of five visits one may be disturbed.
    if count >= LEAST_VISITS and alike >= count - count // MOST_VISITS:
        return "alike"
    return "undecided"


def needed(pair: Sequence[Seen]) -> int:
    """Votes by which a member must lead."""
    if len(pair) < LEAST_VISITS:
        return 1
    votes = [s.vote for s in pair]
    disputed = "first" in votes and "second" in votes
    return LEAST_VISITS if abs(_middle(pair)) > CLEAR and not disputed else LEAD


def _lead(pair: Sequence[Seen]) -> int:
    """Votes for the first less those for the second."""
    votes = [s.vote for s in pair]
    return votes.count("first") - votes.count("second")


def _middle(pair: Sequence[Seen]) -> float:
    return float(np.median([s.middle for s in pair]))


def worth_another(pair: Sequence[Seen]) -> bool:
    """Whether one more visit may decide a pair of which a visit says that it differs by more than CLOSE."""
    count = len(pair)
    if count < LEAST_VISITS:
        return True
    if joined(pair) != "undecided" or max(abs(s.middle) for s in pair) <= CLOSE:
        return False
    return abs(_lead(pair)) + MOST_VISITS - count >= needed(pair)


def _pairs(visits: Sequence[Steady]) -> list[tuple[str, str]]:
    return list(combinations((name for name in visits[0] if name != BASELINE), 2))


def to_visit(visits: Sequence[Steady]) -> list[str]:
    """The members of the pairs that are worth another visit, in order."""
    wanted = {name for a, b in _pairs(visits) if worth_another(seen(visits, a, b)) for name in (a, b)}
    return [name for name in visits[0] if name in wanted]


def open_pairs(visits: Sequence[Steady], net: Mapping[str, float]) -> list[tuple[str, str]]:
    """The pairs whose order stays open.

    net  member -> the net time that is shown; an order that contradicts it is open as well
    """
    found = []
    for a, b in _pairs(visits):
        verdict = joined(seen(visits, a, b))
        backwards = (verdict == "first" and net[a] > net[b]) or (verdict == "second" and net[b] > net[a])
        if verdict == "undecided" or backwards:
            found.append((a, b))
    return found
