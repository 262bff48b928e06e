"""Reads relations.toml: which functions keep which relation, and within what in float64."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from conformance.metamorphic.inputs import colours, exchange, reversal, scaling, turns
from conformance.metamorphic.relation import InputRelation, unchanged

FILE = Path(__file__).parents[1] / "relations.toml"


def load_relations() -> tuple[InputRelation, ...]:
    """The relations of the file, in its order."""
    data = tomllib.loads(FILE.read_text(encoding="utf-8"))
    return tuple(_relation(name, entry) for name, entry in data.items())


def _relation(name: str, entry: dict[str, Any]) -> InputRelation:
    inputs, result = _changes(entry)
    return InputRelation(
        name,
        entry["what"],
        tuple(entry["functions"]),
        inputs,
        result,
        is_exact=entry["exact"],
        tolerance=float(entry["tolerance"]),
        silent=turns.opposed if entry["kind"] in ("quarter turn", "mirror", "rotation") else None,
    )


def _changes(entry: dict[str, Any]) -> tuple[Any, Any]:
    match entry["kind"]:
        case "exchange":
            return exchange.exchange(*entry["parameters"]), unchanged
        case "reverse":
            return reversal.reverse(entry["parameter"]), unchanged
        case "quarter turn" | "mirror" as kind:
            axes = turns.QUARTER_TURN if kind == "quarter turn" else turns.MIRROR
            return turns.axes_input(axes), turns.axes_result(axes, entry["turns"])
        case "rotation":
            return turns.rotation_input, unchanged
        case "scale":
            return scaling.scale(entry["powers"]), scaling.scaled_result(entry["power"])
        case "colours":
            return colours.permute_inputs, colours.permute_result
        case kind:
            raise ValueError(f"{FILE.name}: unknown kind {kind}")
