"""One lane that failed, with all that a reader and a replay need."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from conformance.check.identity import Identity

FINITE, PERMITTED, WITHIN = "finite", "permitted", "within bound"
VERDICTS = (FINITE, PERMITTED, WITHIN)
"""Names of the verdicts on a result, as reports and records carry them."""


@dataclass(frozen=True)
class Missed:
    """A declared bound that a result missed."""

    error: str
    bound: str
    origin: str


@dataclass(frozen=True)
class Failure:
    """One lane for which some verdict is bad.

    failed     names of the verdicts that are bad
    inputs     for people, decimal and hex; words: the same for machines, see conformance.cases.found
    got        what came out, decimal and hex
    expected   the reference's value, in float64
    exact      the function's own program in 50 digits
    table      the accuracy table of the interval; empty where none judged it
    interval   what the table permits; "anything" where it guarantees nothing
    low, high  the same as numbers: lists for vectors, objects for structs
    excess     how far out of its interval the result is, see conformance.check.interval; 0: it is inside
    distance   from the expected value, in ULP
    missed     the bounds that it missed
    """

    identity: Identity
    driver: str
    failed: tuple[str, ...]
    inputs: str
    words: str
    got: str
    expected: str
    exact: str = ""
    table: str = ""
    interval: str = ""
    low: Any = None
    high: Any = None
    excess: float = 0.0
    distance: str = ""
    missed: tuple[Missed, ...] = field(default=())

    @property
    def reason(self) -> str:
        """What is wrong, in a few words."""
        what = {
            FINITE: "the result is not finite",
            PERMITTED: f"outside what {self.table} permits",
            WITHIN: "outside its declared bound",
        }
        return " and ".join(what[name] for name in self.failed)

    def lines(self) -> list[str]:
        """The failure as lines of text; the last one replays it."""
        lines = [
            f"{self.identity.function} on {self.driver}: {self.reason}",
            f"  inputs     {self.inputs}",
            f"  got        {self.got}",
            f"  reference  {self.expected}" + (f" ({self.distance} away)" if self.distance else ""),
        ]
        if self.exact:
            lines.append(f"  exact      {self.exact} (the same program in 50 digits)")
        if self.interval:
            lines.append(f"  {PERMITTED:10} {self._permitted()}")
        for missed in self.missed:
            lines.append(f"  bound      MISSED: {missed.error}; declared: {missed.bound}")
            lines.append(f"             origin: {missed.origin}")
        if FINITE in self.failed:
            lines.append("  finite     NO: every finite input must give a finite result")
        return [*lines, f"  replay     vair check --replay {self.identity}"]

    def _permitted(self) -> str:
        if PERMITTED not in self.failed:
            return f"yes: {self.table} permits {self.interval}"
        return f"NO: {self.table} permits {self.interval}; {self.excess:.4g} half widths from its middle"
