"""What a check finds of one function on one backend: both verdicts, the accuracy beside them, failures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from conformance.check.accuracy import Accuracy
from conformance.check.failure import FINITE, PERMITTED, WITHIN, Failure, Missed
from conformance.check.identity import Identity
from conformance.check.interval import OUTSIDE, IntervalResult

NOT_JUDGED = "not judged"


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

    backend   as a replay identity carries it: the target, or a driver with its mode
    stage     how far it came: emit, compile, execute (where it stopped), or judged
    known     verdict -> the reason of a failure that was expected, see conformance.drivers.known
    bounds    the verdict "within bound", bound by bound
    permitted the verdict "permitted"; None where no interval judged
    accuracy  how far results are from the reference, whatever the verdicts say
    source    hash of the library's sources that the function needs
    emitted   hash of the program that the backend was given; empty for the evaluator
    program   that program, kept where something failed
    """

    function: str
    target: str
    driver: str
    backend: str = ""
    stage: str = "judged"
    known: dict[str, str] = field(default_factory=dict)
    lanes: int = 0
    non_finite: int = 0
    ambiguous: int = 0
    uncovered: int = 0
    seconds: float = 0.0
    bounds: list[BoundResult] = field(default_factory=list)
    permitted: IntervalResult | None = None
    accuracy: list[Accuracy] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)
    broken: str = ""
    source: str = ""
    emitted: str = ""
    program: str = ""

    @property
    def within(self) -> bool:
        """The verdict "within bound": it ran, and no declared bound was missed."""
        return not self.broken and not any(b.failures for b in self.bounds)

    @property
    def interval_verdict(self) -> str:
        """The verdict "permitted": permitted, outside, unguaranteed, or not judged."""
        return self.permitted.verdict if self.permitted is not None else NOT_JUDGED

    @property
    def failed(self) -> tuple[str, ...]:
        """Names of the verdicts that are bad; what did not run is within no bound."""
        bad = {
            FINITE: self.non_finite > 0,
            PERMITTED: self.interval_verdict == OUTSIDE,
            WITHIN: not self.within,
        }
        return tuple(name for name, is_bad in bad.items() if is_bad)

    @property
    def passed(self) -> bool:
        return not self.failed

    @property
    def accepted(self) -> bool:
        """Passed, or failed as expected."""
        return all(name in self.known for name in self.failed)

    def as_data(self) -> dict[str, Any]:
        """Plain data for the JSON result, see result.schema.json."""
        judged = None
        if self.permitted is not None:
            judged = {**asdict(self.permitted), "verdict": self.permitted.verdict}
        data = {
            "function": self.function,
            "target": self.target,
            "driver": self.driver,
            "backend": self.backend,
            "stage": self.stage,
            "passed": self.passed,
            "verdicts": {
                FINITE: self.non_finite == 0,
                PERMITTED: self.interval_verdict,
                WITHIN: self.within,
            },
            "known_failures": self.known,
            "broken": self.broken or None,
            "lanes": self.lanes,
            "non_finite": self.non_finite,
            "ambiguous": self.ambiguous,
            "outside_every_bound": self.uncovered,
            "seconds": round(self.seconds, 3),
            "bounds": [vars(b) for b in self.bounds],
            "permitted": judged,
            "accuracy": [vars(a) for a in self.accuracy],
            "source": self.source,
            "emitted": self.emitted,
            "failures": [self.record(f) for f in self.failures],
        }
        plain: dict[str, Any] = as_json(data)
        return plain

    def record(self, failure: Failure) -> dict[str, Any]:
        """A failure with all that running it elsewhere needs."""
        record: dict[str, Any] = as_json(
            {
                **asdict(failure),
                "reason": failure.reason,
                "identity": str(failure.identity),
                "function": self.function,
                "target": self.target,
                "backend": self.backend,
                "seed": failure.identity.seed,
                "source": self.source,
                "emitted": self.emitted,
                "program": self.program,
            }
        )
        return record

    @staticmethod
    def from_data(data: Mapping[str, Any]) -> FunctionResult:
        """The result that `as_data` gave; raises KeyError, TypeError or ValueError for anything else."""
        failures = [_failure(record) for record in data["failures"]]
        judged = data["permitted"]
        if judged is not None:
            own = {key: value for key, value in judged.items() if key != "verdict"}
            judged = IntervalResult(**{**own, "excess": float(own["excess"])})
        return FunctionResult(
            function=data["function"],
            target=data["target"],
            driver=data["driver"],
            backend=data["backend"],
            stage=data["stage"],
            known=dict(data["known_failures"]),
            lanes=data["lanes"],
            non_finite=data["non_finite"],
            ambiguous=data["ambiguous"],
            uncovered=data["outside_every_bound"],
            seconds=data["seconds"],
            bounds=[_with_floats(BoundResult, b, "measured", "p999", "median") for b in data["bounds"]],
            permitted=judged,
            accuracy=[_with_floats(Accuracy, a, "maximum", "p999", "median") for a in data["accuracy"]],
            failures=failures,
            broken=data["broken"] or "",
            source=data["source"],
            emitted=data["emitted"],
            program=data["failures"][0]["program"] if failures else "",
        )


def as_json(value: Any) -> Any:
    """Plain data with infinite numbers as text: JSON has none."""
    if isinstance(value, Mapping):
        return {key: as_json(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def _with_floats(kind: Any, data: Mapping[str, Any], *names: str) -> Any:
    return kind(**{**data, **{name: float(data[name]) for name in names}})


def _failure(record: Mapping[str, Any]) -> Failure:
    own = {name: record[name] for name in Failure.__dataclass_fields__}
    own["identity"] = Identity.parse(record["identity"])
    own["failed"] = tuple(record["failed"])
    own["excess"] = float(record["excess"])
    own["missed"] = tuple(Missed(**missed) for missed in record["missed"])
    return Failure(**own)
