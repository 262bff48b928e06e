"""Tolerances of unit tests: data with an origin, in ../tolerances.toml."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[1] / "tolerances.toml"


def tolerance(name: str) -> float:
    """The bound of that name."""
    return float(_read()[name]["bound"])


def floor(name: str) -> float:
    """How far values may be off absolutely where the bound is relative."""
    return float(_read()[name]["floor"])


@cache
def _read() -> dict[str, dict[str, Any]]:
    return tomllib.loads(FILE.read_text(encoding="utf-8"))
