"""Known failures as data: read, matched against results, and judged."""

from __future__ import annotations

import contextlib
import datetime
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from codegen.errors import UserError, nearest
from conformance.check.failure import FINITE, PERMITTED, WITHIN
from conformance.check.result import FunctionResult
from conformance.drivers.modes import modes
from targets import Device, TargetUnavailable
from targets.drivers import catalogue, check_match

TABLE = Path(__file__).with_name("known_failures.toml")
KEYS: dict[str, type | tuple[type, ...]] = {
    "function": (str, list),
    "driver": (str, list),
    "mode": (str, list),
    "verdict": str,
    "reason": str,
    "measured": (int, float),
    "share": (int, float),
    "date": datetime.date,
    "expires": datetime.date,
}
JUDGED = (PERMITTED, WITHIN)
"""The verdicts that an entry may speak of; what is not finite or does not run counts as not within bound."""


@dataclass(frozen=True)
class KnownFailure:
    """One entry of known_failures.toml; see there for the fields."""

    functions: tuple[str, ...]
    drivers: tuple[str, ...]
    modes: tuple[str, ...]
    verdict: str
    reason: str
    measured: float
    share: float
    date: datetime.date
    expires: datetime.date

    def covers(self, run: Judged, function: str | None = None) -> bool:
        """Whether the entry speaks of this driver and mode, and of the function if one is given."""
        if run.mode not in self.modes or not any(fnmatchcase(run.driver, glob) for glob in self.drivers):
            return False
        return function is None or any(fnmatchcase(function, glob) for glob in self.functions)

    def __str__(self) -> str:
        where = f"{', '.join(self.drivers)} ({', '.join(self.modes)})"
        return f'known failure of "{self.verdict}": {", ".join(self.functions)} on {where}'


@dataclass(frozen=True)
class Judged:
    """Results of one driver in one mode, as entries speak of them.

    driver  name and version, for example "pocl 3.1+debian"
    whole   whether all inputs of the mode were run; with fewer, a known failure may not show
    """

    driver: str
    mode: str
    results: Sequence[FunctionResult]
    whole: bool = True


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
    named = {key: _texts(shown, key, entry[key]) for key in ("function", "driver", "mode")}
    for mode in named["mode"]:
        if mode not in modes():
            raise UserError(f'{shown}: unknown mode "{mode}"{nearest(mode, modes())}')
    if entry["verdict"] not in JUDGED:
        raise UserError(f'{shown}: unknown verdict "{entry["verdict"]}"{nearest(entry["verdict"], JUDGED)}')
    if not 0.0 < entry["share"] <= 1.0:
        raise UserError(f'{shown}: "share" is a share of the results, above 0 and at most 1')
    if not entry["reason"].strip():
        raise UserError(f'{shown}: "reason" is empty')
    if not entry["measured"] > 1.0:
        raise UserError(f'{shown}: "measured" is how far out it is, above 1, not {entry["measured"]}')
    if entry["expires"] <= entry["date"]:
        raise UserError(f'{shown}: "expires" is not after "date"')
    return KnownFailure(
        functions=named["function"],
        drivers=named["driver"],
        modes=named["mode"],
        verdict=entry["verdict"],
        reason=" ".join(entry["reason"].split()),
        measured=float(entry["measured"]),
        share=float(entry["share"]),
        date=entry["date"],
        expires=entry["expires"],
    )


def _texts(shown: str, key: str, value: Any) -> tuple[str, ...]:
    texts = value if isinstance(value, list) else [value]
    if not texts or not all(isinstance(text, str) for text in texts):
        raise UserError(f'{shown}: "{key}" is a text or a list of texts')
    return tuple(texts)


def excess(result: FunctionResult, verdict: str = WITHIN) -> float:
    """How far out the worst result is: 1 is the bound, or the end of the interval.

    Infinite where a result is not finite or nothing executes; 0 where the verdict is good.
    """
    if verdict == PERMITTED:
        judged = result.permitted
        return judged.excess if judged is not None and judged.outside else 0.0
    if result.broken or result.non_finite:
        return float("inf")
    ratios = [b.measured / b.limit if b.limit else float("inf") for b in result.bounds if b.failures]
    return max(ratios, default=0.0)


def share(result: FunctionResult, verdict: str) -> float:
    """The share of the results for which the verdict is bad."""
    if verdict == PERMITTED:
        judged = result.permitted
        return judged.outside / max(judged.lanes, 1) if judged is not None else 0.0
    if result.broken:
        return 1.0
    return max([result.non_finite, *(b.failures for b in result.bounds)]) / max(result.lanes, 1)


def judge(runs: Iterable[Judged], known: Iterable[KnownFailure], today: datetime.date) -> Verdict:
    """Mark failures that are known, and complain of entries that no longer tell the truth."""
    verdict = Verdict()
    entries = list(known)
    for run in runs:
        for entry in (e for e in entries if e.covers(run)):
            if entry.expires < today:
                verdict.complaints.append(f"{entry} expired on {entry.expires}: look at it again")
            for result in (r for r in run.results if entry.covers(run, r.function)):
                sentence = _mark(result, entry, run.whole)
                if sentence:
                    verdict.complaints.append(f"{entry}: {sentence}")
                verdict.expected += entry.verdict in result.known
    return verdict


def _mark(result: FunctionResult, entry: KnownFailure, whole: bool) -> str:
    """Mark one result as known; a sentence where the entry does not describe it."""
    names = (PERMITTED,) if entry.verdict == PERMITTED else (FINITE, WITHIN)
    failed = [name for name in names if name in result.failed]
    if not failed:
        return f"{result.function} passes; remove it from the list" if whole else ""
    found, part = excess(result, entry.verdict), share(result, entry.verdict)
    if found > entry.measured:
        what = "of its bound" if entry.verdict == WITHIN else "half widths of its interval"
        return f"{result.function} errs by {found:.4g} {what}, more than the {entry.measured:.4g} known"
    if part > entry.share:
        return f"{result.function} errs in {part:.2g} of the results, more than the {entry.share:.2g} known"
    result.known.update(dict.fromkeys(failed, entry.reason))
    return ""


def name_of(device: Device | None) -> str:
    """Name and version of the driver of the catalogue that a device fits; empty for none."""
    if device is None:
        return ""
    for chosen in catalogue().values():
        if chosen.target != device.target or chosen.system:
            continue
        with contextlib.suppress(TargetUnavailable):
            check_match(chosen, device)
            return f"{chosen.name} {chosen.version_of(device)}".strip()
    return ""
