"""Whether two measurements agree on which of two variants is faster."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from conformance.bench.stopping import CLOSE

Result = Mapping[str, Any]


@dataclass(frozen=True)
class Pair:
    """Two members of a group in one mode on one driver, with the net time of the second over the first's.

    now, before  that quotient in each measurement; None where a net time is not positive
    decided      whether both measurements tell their order
    """

    driver: str
    mode: str
    first: str
    second: str
    now: float | None
    before: float | None
    decided: bool

    @property
    def differs(self) -> bool:
        """Whether a measurement says that they differ by more than CLOSE."""
        return any(q is not None and max(q, 1.0 / q) > 1.0 + CLOSE for q in (self.now, self.before))

    @property
    def contradicts(self) -> bool:
        """Whether the measurements put them in opposite orders."""
        return self.now is not None and self.before is not None and (self.now - 1.0) * (self.before - 1.0) < 0

    def __str__(self) -> str:
        quotients = " then ".join("lost" if q is None else f"{q:.3f}" for q in (self.before, self.now))
        return f"{self.driver}, {self.mode}: {self.second} over {self.first} {quotients}"


def pairs(now: Result, before: Result) -> Iterator[Pair]:
    """All pairs of members that two results of one driver have in common and that differ."""
    then = {f["name"]: f for f in before["functions"]}
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for f in now["functions"]:
        if f["name"] in then:
            groups.setdefault(f["base"], []).append(f)
    open_pairs = undecided(now) | undecided(before)
    for members in groups.values():
        for a, b in combinations(members, 2):
            for mode in a["speed"]:
                old = [then[f["name"]]["speed"].get(mode) for f in (a, b)]
                if None in old:
                    continue
                pair = Pair(
                    now["device"]["short"],
                    mode,
                    a["name"],
                    b["name"],
                    _quotient(a["speed"][mode], b["speed"][mode]),
                    _quotient(*old),
                    (mode, frozenset((a["name"], b["name"]))) not in open_pairs,
                )
                if pair.differs:
                    yield pair


def undecided(result: Result) -> set[tuple[str, frozenset[str]]]:
    """Mode and names of the pairs whose order a result leaves open."""
    return {
        (mode, frozenset(pair))
        for group in result["groups"]
        for mode, data in group["modes"].items()
        for pair in data["undecided"]
    }


def _quotient(a: Any, b: Any) -> float | None:
    above = a["net_ns"], b["net_ns"]
    return above[1] / above[0] if min(above) > 0.0 else None


@dataclass(frozen=True)
class Agreement:
    """Pairs that differ, those of them whose order was decided in both, and where the orders contradict."""

    differ: int
    decided: int
    contradictions: tuple[Pair, ...]


def agreement(now: Sequence[Result], before: Sequence[Result]) -> Agreement:
    """How far two measurements agree, over all drivers that both have."""
    earlier = {(r["device"]["target"], r["device"]["short"]): r for r in before}
    found: list[Pair] = []
    for r in now:
        old = earlier.get((r["device"]["target"], r["device"]["short"]))
        if old is not None:
            found += pairs(r, old)
    decided = [p for p in found if p.decided]
    return Agreement(len(found), len(decided), tuple(p for p in decided if p.contradicts))
