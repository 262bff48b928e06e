"""Tolerances of pictures: data with an origin, in tolerances.toml beside this file."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any


def tolerance(name: str) -> float:
    """The bound of that name."""
    bound: float = _read()[name]["bound"]
    return bound


@cache
def _read() -> dict[str, dict[str, Any]]:
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
