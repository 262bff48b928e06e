"""What `vair verify` found, as lines for people and as data for programs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from codegen.ir.domains import number
from codegen.vendor.changes import Change, Difference
from codegen.vendor.lock import Promise
from codegen.vendor.state import FileState

FORMAT = 1
"""Counts incompatible changes of the data."""


@dataclass(frozen=True)
class Finding:
    """A vendored folder against this version.

    old, new  versions of Vair
    """

    folder: str
    old: str
    new: str
    files: Sequence[FileState]
    changes: Sequence[Change]

    @property
    def clean(self) -> bool:
        """Whether nothing drifted."""
        return not self.files and not self.changes


def lines(finding: Finding) -> Iterator[str]:
    """One line per file and function, what differs in value first."""
    versions = finding.old if finding.old == finding.new else f"{finding.old}, now {finding.new}"
    if finding.clean:
        yield f"{finding.folder}: as Vair {versions} writes it"
        return
    counted = Counter(f.state for f in finding.files)
    summary = ", ".join(f"{count} {state}" for state, count in sorted(counted.items())) or "files as locked"
    yield f"{finding.folder}: Vair {versions}; {summary}; {_functions(len(finding.changes))} would change"
    for f in finding.files:
        yield f"  {f.state:10} {f.file}" + (f" ({f.note})" if f.note else "")
    for change in sorted(finding.changes, key=_largest, reverse=True):
        yield from _change_lines(change)


def _functions(count: int) -> str:
    return f"{count or 'no'} function{'' if count == 1 else 's'}"


def _change_lines(change: Change) -> Iterator[str]:
    name = change.function
    if change.kind in ("added", "removed"):
        yield f"  {name}: {change.kind}"
        return
    assert change.old is not None and change.new is not None
    if change.kind == "signature":
        yield f"  {name}: {change.old.signature} becomes {change.new.signature}"
    elif change.kind == "promise":
        yield f"  {name}: the same code"
    said: dict[str, list[str]] = {}
    for d, found in change.differences.items():
        said.setdefault(_difference(found), []).append(d)
    for sentence, dialects in said.items():
        yield f"  {name} [{', '.join(dialects)}]: {sentence}"
    if change.old.errors != change.new.errors:
        yield f"    error was  {'; '.join(change.old.errors) or 'not declared'}"
        yield f"    error now  {'; '.join(change.new.errors) or 'not declared'}"


def _difference(found: Difference | str) -> str:
    if isinstance(found, str):
        return found
    where = f"{found.points} points, {found.driver}"
    if found.absolute == 0.0 and not any(found.non_finite):
        return f"other code, the same values ({where})"
    text = f"values differ by up to {_short(found.absolute)}, relatively {_short(found.relative)} ({where})"
    if any(found.non_finite):
        text += f"; not finite: {found.non_finite[0]} results before, {found.non_finite[1]} now"
    return text


def _short(value: float) -> str:
    return number(float(f"{value:.2g}"))


def _largest(change: Change) -> float:
    """Order of the lines: what cannot be called as before, then the largest difference."""
    if change.kind in ("removed", "signature", "structs"):
        return float("inf")
    return max((d.absolute for d in change.differences.values() if isinstance(d, Difference)), default=-1.0)


def as_data(finding: Finding) -> dict[str, Any]:
    """The same as plain data, for --json."""
    return {
        "format": FORMAT,
        "folder": finding.folder,
        "clean": finding.clean,
        "version": {"vendored": finding.old, "installed": finding.new},
        "files": [{"file": f.file, "state": f.state, "note": f.note or None} for f in finding.files],
        "functions": [
            {
                "function": c.function,
                "kind": c.kind,
                "old": _promised(c.old),
                "new": _promised(c.new),
                "dialects": c.dialects,
                "differences": {d: _measured(found) for d, found in c.differences.items()},
            }
            for c in finding.changes
        ],
    }


def _promised(p: Promise | None) -> dict[str, Any] | None:
    return None if p is None else {"signature": p.signature, "errors": list(p.errors)}


def _measured(found: Difference | str) -> dict[str, Any]:
    if isinstance(found, str):
        return {"not_executed": found}
    return {
        "driver": found.driver,
        "points": found.points,
        "absolute": found.absolute,
        "relative": found.relative,
        "at": found.where or None,
        "non_finite": {"old": found.non_finite[0], "new": found.non_finite[1]},
    }
