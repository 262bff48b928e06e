"""Known failures as data: read, matched against results, and judged."""

from __future__ import annotations

import datetime
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from codegen.errors import UserError, nearest
from conformance.check.result import FunctionResult
from conformance.drivers.modes import modes
from conformance.drivers.run import DriverRun

TABLE = Path(__file__).with_name("known_failures.toml")
KEYS: dict[str, type | tuple[type, ...]] = {
    "function": (str, list),
    "driver": str,
    "mode": str,
    "reason": str,
    "measured": (int, float),
    "date": datetime.date,
    "expires": datetime.date,
}


@dataclass(frozen=True)
class KnownFailure:
    """One entry of known_failures.toml; see there for the fields."""

    functions: tuple[str, ...]
    driver: str
    mode: str
    reason: str
    measured: float
    date: datetime.date
    expires: datetime.date

    def covers(self, run: DriverRun, function: str | None = None) -> bool:
        """Whether the entry speaks of this driver and mode, and of the function if one is given."""
        full = f"{run.driver.name} {run.driver.version_of(run.device)}".strip()
        if self.mode != run.mode.name or not fnmatchcase(full, self.driver):
            return False
        return function is None or any(fnmatchcase(function, glob) for glob in self.functions)

    def __str__(self) -> str:
        return f"known failure {', '.join(self.functions)} on {self.driver} ({self.mode})"


@dataclass
class Verdict:
    """What the known failures make of the results; `complaints` are failures of the check."""

    complaints: list[str] = field(default_factory=list)
    expected: int = 0


def read(path: Path = TABLE) -> list[KnownFailure]:
    """Every known failure; raises UserError with one sentence that names entry and key."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as e:
        raise UserError(f"{path.name}: not valid TOML: {e}") from None
    for key in table:
        if key != "failure":
            raise UserError(f'{path.name}: unknown table "{key}"; entries stand under [[failure]]')
    return [_entry(entry, f"{path.name}: failure {k}") for k, entry in enumerate(table.get("failure", []), 1)]


def _entry(entry: dict[str, Any], shown: str) -> KnownFailure:
    for key in entry:
        if key not in KEYS:
            raise UserError(f'{shown}: unknown key "{key}"{nearest(key, KEYS)}')
    for key, type_ in KEYS.items():
        if key not in entry:
            raise UserError(f'{shown}: the key "{key}" is missing')
        if not isinstance(entry[key], type_) or isinstance(entry[key], bool):
            raise UserError(f'{shown}: "{key}" is {entry[key]!r}, which is of the wrong type')
    if entry["mode"] not in modes():
        raise UserError(f'{shown}: unknown mode "{entry["mode"]}"{nearest(entry["mode"], modes())}')
    if not entry["reason"].strip():
        raise UserError(f'{shown}: "reason" is empty')
    if not entry["measured"] > 1.0:
        raise UserError(f'{shown}: "measured" is error / bound, above 1, not {entry["measured"]}')
    if entry["expires"] <= entry["date"]:
        raise UserError(f'{shown}: "expires" is not after "date"')
    globs = entry["function"] if isinstance(entry["function"], list) else [entry["function"]]
    if not globs or not all(isinstance(glob, str) for glob in globs):
        raise UserError(f'{shown}: "function" is a glob or a list of globs')
    return KnownFailure(
        functions=tuple(globs),
        driver=entry["driver"],
        mode=entry["mode"],
        reason=" ".join(entry["reason"].split()),
        measured=float(entry["measured"]),
        date=entry["date"],
        expires=entry["expires"],
    )


def excess(result: FunctionResult) -> float:
    """Largest error over its bound; infinite where a result is not finite or nothing executes."""
    if result.broken or result.non_finite:
        return float("inf")
    ratios = [b.measured / b.limit if b.limit else float("inf") for b in result.bounds if b.failures]
    return max(ratios, default=0.0)


def judge(runs: Iterable[DriverRun], known: Iterable[KnownFailure], today: datetime.date) -> Verdict:
    """Mark failures that are known, and complain of entries that no longer tell the truth."""
    verdict = Verdict()
    entries = list(known)
    for run in runs:
        for entry in (e for e in entries if e.covers(run)):
            if entry.expires < today:
                verdict.complaints.append(f"{entry} expired on {entry.expires}: look at it again")
            for result in (r for r in run.results if entry.covers(run, r.function)):
                sentence = _mark(result, entry)
                if sentence:
                    verdict.complaints.append(f"{entry}: {sentence}")
                verdict.expected += bool(result.known)
    return verdict


def _mark(result: FunctionResult, entry: KnownFailure) -> str:
    """Mark one result as known; a sentence where the entry does not describe it."""
    if result.passed:
        return f"{result.function} passes; remove it from the list"
    found = excess(result)
    if found > entry.measured:
        return f"{result.function} errs by {found:.4g} of its bound, more than the {entry.measured:.4g} known"
    result.known = entry.reason
    return ""
