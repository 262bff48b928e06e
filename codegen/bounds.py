"""Declared error bounds: numbers with a measure, a domain and an origin. Data beside the source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from codegen.errors import UserError, nearest
from codegen.ir.domains import number

MEASURES = ("relative", "absolute", "exact")
KEYS = ("measure", "bound", "floor", "where", "field", "targets", "domain", "origin")


@dataclass(frozen=True)
class Bound:
    """One declared bound of a function.

    measure  relative: |got - reference| / max(|reference|, floor); absolute: |got - reference|, for vectors
             the largest component; exact: bit for bit
    where    feature -> closed interval; the bound holds for inputs with every feature inside. Features are
             scalar parameters, struct fields (p.field), components (u.y), angle(x, y) between x and the
             line of y, apart(x, y) of two numbers, dot(x, y) and length(x)
    field    the field of a struct result it speaks of; all fields if empty
    targets  the targets it speaks of; all if empty
    domain   the same in words, for the emitted comment
    origin   where the number comes from
    """

    function: str
    measure: str
    bound: float
    domain: str
    origin: str
    floor: float = 0.0
    where: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    field: str = ""
    targets: tuple[str, ...] = ()

    def describe(self) -> str:
        """The bound as one phrase."""
        what = f"{self.field}: " if self.field else ""
        if self.measure == "exact":
            return f"{what}exact ({self.domain})"
        floor = f" (floor {number(self.floor)})" if self.measure == "relative" and self.floor else ""
        only = f", {' and '.join(self.targets)} only" if self.targets else ""
        return f"{what}{self.measure} <= {number(self.bound)}{floor}: {self.domain}{only}"


def read_bounds(shown_path: str, data: Mapping[str, Any]) -> dict[str, list[Bound]]:
    """Bounds by function from parsed TOML; raises UserError naming file, function and key."""
    found: dict[str, list[Bound]] = {}
    for name, entries in data.items():
        where = f"{shown_path}: {name}"
        if not isinstance(entries, list) or not all(isinstance(entry, Mapping) for entry in entries):
            raise UserError(f"{where}: bounds are tables, written [[{name}]]")
        try:
            found[name] = [_read(where, name, entry) for entry in entries]
        except (TypeError, ValueError, AttributeError):
            raise UserError(f"{where}: a value has the wrong type; see codegen/bounds.py") from None
    return found


def _read(where: str, name: str, entry: Mapping[str, Any]) -> Bound:
    for key in entry:
        if key not in KEYS:
            raise UserError(f'{where}: unknown key "{key}"{nearest(key, KEYS)}')
    missing = [key for key in ("measure", "domain", "origin") if key not in entry]
    if missing:
        raise UserError(f"{where}: a bound needs {', '.join(missing)}")
    measure = entry["measure"]
    if measure not in MEASURES:
        raise UserError(f'{where}: unknown measure "{measure}"{nearest(str(measure), MEASURES)}')
    if measure != "exact" and "bound" not in entry:
        raise UserError(f"{where}: a bound needs its number")
    for key in ("domain", "origin"):
        if not entry[key].isascii():
            raise UserError(f"{where}: {key} is ASCII: it is emitted into shaders")
    return Bound(
        function=name,
        measure=measure,
        bound=float(entry.get("bound", 0.0)),
        domain=entry["domain"],
        origin=entry["origin"],
        floor=float(entry.get("floor", 0.0)),
        where={feature: (float(low), float(high)) for feature, (low, high) in entry.get("where", {}).items()},
        field=entry.get("field", ""),
        targets=tuple(entry.get("targets", ())),
    )
