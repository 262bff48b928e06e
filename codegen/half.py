"""What is declared of half precision: rules for the pass, and which functions are of use and where.

shaderlib/half.toml says what a person decides: constants that are no halves, parameters that stay f32, why
a function is of no use. shaderlib/half.json says what was measured; `python -m conformance.half` writes it.
"""

from __future__ import annotations

import functools
import hashlib
import json
import struct
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codegen.bounds import Bound
from codegen.errors import UserError
from codegen.library import Library
from codegen.passes.half import HalfRules

RULES, MEASURED = "half.toml", "half.json"


@dataclass(frozen=True)
class HalfForm:
    """What is known of a function's half form.

    refused   why there is none; empty where there is one
    instead   the nearest function that has one; empty for none
    single    parameters that stay f32
    where     feature -> closed interval: inputs for which the errors hold, see codegen.bounds.Bound
    bounds    measured errors as bounds, each with its domain and origin
    executed  largest errors seen on devices that compute in half precision: target, driver, error
    """

    function: str
    refused: str = ""
    instead: str = ""
    single: tuple[str, ...] = ()
    where: Mapping[str, tuple[float, float]] | None = None
    bounds: tuple[Bound, ...] = ()
    executed: tuple[Mapping[str, Any], ...] = ()

    def as_data(self) -> dict[str, Any]:
        """For `vair list --json`."""
        if self.refused:
            return {"valid": False, "why": self.refused, "instead": self.instead or None}
        return {
            "valid": True,
            "single": list(self.single),
            "where": {k: list(v) for k, v in (self.where or {}).items()},
            "error": [
                {"measure": b.measure, "bound": b.bound, "floor": b.floor, "field": b.field or None}
                for b in self.bounds
            ],
            "domain": self.bounds[0].domain if self.bounds else None,
            "origin": self.bounds[0].origin if self.bounds else None,
            "executed": [dict(row) for row in self.executed],
        }


def single_precision(value: float) -> float:
    """The nearest float32."""
    rounded: float = struct.unpack("<f", struct.pack("<f", value))[0]
    return rounded


@functools.cache
def _declared(root: Path) -> dict[str, Any]:
    path = root / RULES
    if not path.exists():
        return {}
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as e:
        raise UserError(f"{path.parent.name}/{RULES}: not valid TOML: {e}") from None


def _measured(root: Path) -> dict[str, Any]:
    path = root / MEASURED
    if not path.exists():
        return {}
    try:
        found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except json.JSONDecodeError as e:
        raise UserError(f"{path.parent.name}/{MEASURED}: not valid JSON: {e}") from None
    return found


def declared(library: Library) -> dict[str, Any]:
    """half.toml of the library; empty where it has none."""
    return _declared(library.root)


@functools.cache
def half_rules(library: Library) -> HalfRules:
    """The rules of the library's half forms: declared constants, and which parameters stay f32."""
    return HalfRules(
        declared_constants(library),
        {name: frozenset(form.single) for name, form in half_forms(library).items() if form.single}
        | {name: frozenset(kept) for name, kept in declared(library).get("single", {}).items()},
    )


def declared_constants(library: Library) -> dict[tuple[float, str], float]:
    """(float32 value, function or "") -> half, as HalfRules takes it."""
    constants: dict[tuple[float, str], float] = {}
    for row in declared(library).get("constant", ()):
        for function in row.get("functions", ("",)):
            constants[single_precision(float(row["value"])), function] = float(row["half"])
    return constants


@functools.cache
def half_forms(library: Library) -> dict[str, HalfForm]:
    """What is known of each function's half form, by name."""
    return {name: form_of(name, row) for name, row in _measured(library.root).items()}


def form_of(name: str, row: Mapping[str, Any]) -> HalfForm:
    """A function's row of half.json."""
    if "refused" in row:
        return HalfForm(name, row["refused"], row.get("instead", ""))
    where = {k: (float(low), float(high)) for k, (low, high) in row["where"].items()}
    bounds = tuple(
        Bound(
            function=name,
            measure=e["measure"],
            bound=e["bound"],
            domain=row["domain"],
            origin=row["origin"],
            floor=e.get("floor", 0.0),
            where=where,
        )
        for e in row["errors"]
    )
    return HalfForm(name, "", "", tuple(row["single"]), where, bounds, tuple(row.get("executed", ())))


def half_hash(library: Library, source_hash: str) -> str:
    """The hash of sources together with what the half form of any function depends on."""
    paths = [library.root / name for name in (RULES, MEASURED)]
    parts = [source_hash, *(path.read_text(encoding="utf-8") for path in paths if path.exists())]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def has_half(library: Library, name: str) -> bool:
    """Whether a function has a half form that is of use."""
    form = half_forms(library).get(name)
    return form is not None and not form.refused


def check_half(library: Library, names: Iterable[str]) -> None:
    """Raise UserError for the first function that has no half form: why, and what to use instead."""
    forms = half_forms(library)
    for name in names:
        library.function(name)
        form = forms.get(name)
        if form is None:
            raise UserError(f"{name} has no measured half form; use --precision single")
        if form.refused:
            instead = f"; use {form.instead}" if form.instead else "; use --precision single"
            raise UserError(f"{name} is of no use in half precision: {form.refused}{instead}")
