"""What specifications guarantee of each function, and what they leave open.

shaderlib/guarantees.json holds what `python -m conformance.guarantees` surveyed by interval evaluation, the
share of each function's domain and the largest error per table; shaderlib/guarantees.toml says why what is
not guaranteed is not. A declared bound says what drivers do, measured with a margin; a guarantee is what the
specification alone permits at its worst. Either may be the smaller of the two.
"""

from __future__ import annotations

import functools
import json
import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Protocol

from codegen.bounds import Bound
from codegen.errors import UserError
from codegen.ir.domains import number
from codegen.library import Library

SURVEYED, OPEN = "guarantees.json", "guarantees.toml"
SPECIFICATIONS: Mapping[str, str] = {
    "wgsl": "WGSL",
    "vulkan": "Vulkan",
    "glsl": "OpenGL",
    "glsl_es": "OpenGL ES",
    "opencl": "OpenCL",
    "opencl_relaxed": "OpenCL fast-relaxed",
}
"""Accuracy table -> whose promises it holds."""
_TABLES = {"vulkan450": "vulkan", "es300": "glsl_es", "es310": "glsl_es"}


@dataclass(frozen=True)
class Guarantee:
    """What a table guarantees of a function, on the inputs that were drawn.

    uniform  share of the random points of the domain whose result is bounded
    hard     the same of all hard cases
    errors   for each declared bound, in its measure, the largest error that a permitted result has; None
             where the bound met no guaranteed input or speaks of another target
    causes   cause -> share of all inputs that it leaves without a guarantee
    """

    uniform: float
    hard: float
    errors: Sequence[float | None] = ()
    causes: Mapping[str, float] = field(default_factory=dict)

    @property
    def everywhere(self) -> bool:
        return self.uniform == 1.0 and self.hard == 1.0

    def as_data(self) -> dict[str, Any]:
        """As it stands in the file; infinity as a word."""
        errors = ["inf" if e is not None and math.isinf(e) else e for e in self.errors]
        data: dict[str, Any] = {"uniform": self.uniform, "hard": self.hard, "errors": errors}
        return {**data, "causes": dict(self.causes)} if self.causes else data


@dataclass(frozen=True)
class Surveyed:
    """The guarantees of one function.

    of      what was surveyed: a hash of the function's meaning and of its bounds
    tables  table -> guarantee
    """

    of: str
    tables: Mapping[str, Guarantee]


@dataclass(frozen=True)
class Exempt:
    """Functions of which a table need not guarantee everything.

    function, table  patterns of names
    reason           why not
    cost             what closing it would cost
    """

    function: str
    table: str
    reason: str
    cost: str

    def covers(self, function: str, table: str) -> bool:
        """Whether it speaks of this pair."""
        return fnmatchcase(function, self.function) and fnmatchcase(table, self.table)


def guarantees(library: Library) -> Mapping[str, Surveyed]:
    """The surveyed guarantees of a library's functions; empty where none is kept."""
    path = library.root / SURVEYED
    return _read(path, path.stat().st_mtime_ns) if path.exists() else {}


@functools.lru_cache(maxsize=4)
def _read(path: Path, _changed: int) -> Mapping[str, Surveyed]:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        return {name: _surveyed(entry) for name, entry in data.items()}
    except (json.JSONDecodeError, KeyError, TypeError, ValueError, AttributeError) as e:
        raise UserError(
            f"shaderlib/{path.name}: not readable ({e}); write it anew: python -m conformance.guarantees"
        ) from None


def _surveyed(entry: Mapping[str, Any]) -> Surveyed:
    tables = {
        table: Guarantee(
            row["uniform"],
            row["hard"],
            tuple(None if e is None else float(e) for e in row["errors"]),
            row.get("causes", {}),
        )
        for table, row in entry["tables"].items()
    }
    return Surveyed(entry["of"], tables)


def exempt(library: Library) -> tuple[Exempt, ...]:
    """What need not be guaranteed, each with its reason; raises UserError for an incomplete entry."""
    path = library.root / OPEN
    if not path.exists():
        return ()
    entries = tomllib.loads(path.read_text(encoding="utf-8")).get("open", [])
    try:
        return tuple(Exempt(**entry) for entry in entries)
    except TypeError as e:
        raise UserError(f"shaderlib/{OPEN}: an entry has function, table, reason and cost: {e}") from None


class Spoken(Protocol):
    """What is asked of a dialect here: printing comes later than this."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def target(self) -> str:
        """The target that runs it."""


def table_of(dialect: Spoken) -> str:
    """The accuracy table that a dialect's text runs under."""
    return _TABLES.get(dialect.name, dialect.target)


def phrase(table: str, found: Guarantee, bounds: Sequence[Bound], target: str | None = None) -> str:
    """A guarantee in one line: the share of the domain, and the error for each declared bound in turn.

    bounds  of the function, all of them
    target  leave out bounds of other targets
    """
    if found.everywhere:
        share = "100 % of the domain"
    else:
        share = f"{_percent(found.uniform)} % of the domain, {_percent(found.hard)} % of the hard cases"
    shown = [
        (b, e)
        for b, e in zip(bounds, found.errors, strict=False)
        if target is None or not b.targets or target in b.targets
    ]
    to = ""
    if any(e is not None for _, e in shown):
        measures = [b.measure for b, _ in shown]
        kept = [
            error(b, e, "" if b.measure in measures[k + 1 : k + 2] else b.measure)
            for k, (b, e) in enumerate(shown)
        ]
        to = ", to " + ", ".join(kept) + (" in turn" if len(kept) > 1 else "")
    return f"{share} by the {SPECIFICATIONS[table]} specification{to}"


def error(bound: Bound, found: float | None, measure: str) -> str:
    """One guaranteed error in the measure of a declared bound."""
    if found is None:
        return "nothing"
    if math.isinf(found):
        return "any error"
    if bound.measure == "exact":
        return "exact" if found == 0.0 else f"{number(found)} off"
    return f"{number(found)} {measure}".rstrip()


def _percent(share: float) -> str:
    return f"{math.floor(share * 1e4) / 100:g}"
