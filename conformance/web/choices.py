"""What the page offers, read from choices.toml: variants to choose among, parameters with their ranges."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Shading:
    """One variant to choose.

    formulas  "right" or "printed"
    unused    paths of parameters that it does not read
    """

    name: str
    label: str
    formulas: str
    note: str
    unused: tuple[str, ...] = ()


@dataclass(frozen=True)
class Parameter:
    """One control.

    sets  what it sets: members of the coat, or parameters of the shading function by path
    kind  "linear", "logarithmic", "whole" or "colour"; colours have no range
    """

    label: str
    group: str
    sets: tuple[str, ...]
    kind: str
    least: float = 0.0
    most: float = 1.0


@dataclass(frozen=True)
class Choices:
    """What the page offers.

    base      the variant that the others are compared with
    misprint  key of the printed formulas' misprint in conformance.printed
    """

    base: str
    misprint: str
    shadings: tuple[Shading, ...]
    parameters: tuple[Parameter, ...]

    def only(self, *names: str) -> Choices:
        """The same with these variants alone."""
        return replace(self, shadings=tuple(s for s in self.shadings if s.name in names))


@cache
def choices() -> Choices:
    """The content of choices.toml."""
    data = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    return Choices(
        base=data["base"],
        misprint=data["misprint"],
        shadings=tuple(Shading(**_with_tuples(entry)) for entry in data["shading"]),
        parameters=tuple(Parameter(**_with_tuples(entry)) for entry in data["parameter"]),
    )


def _with_tuples(entry: dict[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()}
