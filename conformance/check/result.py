"""What a check finds: the measured error per bound, and failures with all that replaying them needs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from conformance.check.identity import Identity


@dataclass(frozen=True)
class Failure:
    """One lane that missed a bound, or gave a non-finite result.

    inputs  for people, decimal and hex; words: the same for machines, see conformance.cases.found
    """

    identity: Identity
    driver: str
    reason: str
    inputs: str
    got: str
    expected: str
    error: str
    bound: str
    origin: str
    words: str = ""

    def lines(self) -> list[str]:
        """The failure as lines of text; the last one replays it."""
        return [
            f"{self.identity.function} on {self.driver}: {self.reason}",
            f"  inputs    {self.inputs}",
            f"  got       {self.got}",
            f"  expected  {self.expected}",
            f"  error     {self.error}",
            f"  bound     {self.bound}",
            f"  origin    {self.origin}",
            f"  replay    vair check --replay {self.identity}",
        ]


@dataclass
class BoundResult:
    """One declared bound against everything that was drawn inside its domain."""

    bound: str
    limit: float
    measured: float = 0.0
    p999: float = 0.0
    median: float = 0.0
    worst: str = ""
    lanes: int = 0
    failures: int = 0


@dataclass
class FunctionResult:
    """One function on one backend.

    backend  as a replay identity carries it: the target, or a driver with its mode
    stage    how far it came: emit, compile, execute (where it stopped), or judged
    known    the reason of a failure that was expected, see conformance.drivers.known
    source   hash of the library's sources that the function needs
    emitted  hash of the program that a target was given; empty for the evaluator and for drivers with a mode
    """

    function: str
    target: str
    driver: str
    backend: str = ""
    stage: str = "judged"
    known: str = ""
    lanes: int = 0
    non_finite: int = 0
    ambiguous: int = 0
    uncovered: int = 0
    seconds: float = 0.0
    bounds: list[BoundResult] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)
    broken: str = ""
    source: str = ""
    emitted: str = ""

    @property
    def passed(self) -> bool:
        return not self.failures and not self.broken

    @property
    def accepted(self) -> bool:
        """Passed, or failed as expected."""
        return self.passed or bool(self.known)

    def as_data(self) -> dict[str, Any]:
        """Plain data for the JSON result."""
        return {
            "function": self.function,
            "target": self.target,
            "driver": self.driver,
            "backend": self.backend,
            "passed": self.passed,
            "known_failure": self.known or None,
            "broken": self.broken or None,
            "lanes": self.lanes,
            "non_finite": self.non_finite,
            "ambiguous": self.ambiguous,
            "outside_every_bound": self.uncovered,
            "seconds": round(self.seconds, 3),
            "bounds": [vars(b) for b in self.bounds],
            "source": self.source,
            "emitted": self.emitted,
            "failures": [self._record(f) for f in self.failures],
        }

    def _record(self, failure: Failure) -> dict[str, Any]:
        """A failure with all that running it elsewhere needs."""
        return {
            **vars(failure),
            "identity": str(failure.identity),
            "function": self.function,
            "target": self.target,
            "backend": self.backend,
            "seed": failure.identity.seed,
            "source": self.source,
            "emitted": self.emitted,
        }

    @staticmethod
    def from_data(data: Mapping[str, Any]) -> FunctionResult:
        """The result that `as_data` gave; raises KeyError or TypeError for anything else."""
        failures = []
        for record in data["failures"]:
            own = {f.name: record[f.name] for f in fields(Failure)}
            failures.append(Failure(**{**own, "identity": Identity.parse(record["identity"])}))
        return FunctionResult(
            function=data["function"],
            target=data["target"],
            driver=data["driver"],
            backend=data["backend"],
            known=data["known_failure"] or "",
            lanes=data["lanes"],
            non_finite=data["non_finite"],
            ambiguous=data["ambiguous"],
            uncovered=data["outside_every_bound"],
            seconds=data["seconds"],
            bounds=[BoundResult(**b) for b in data["bounds"]],
            failures=failures,
            broken=data["broken"] or "",
            source=data["source"],
            emitted=data["emitted"],
        )
