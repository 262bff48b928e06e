"""The tolerances of checks.toml."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

FILE = Path(__file__).parent / "checks.toml"
CHECKS: dict[str, Any] = tomllib.loads(FILE.read_text(encoding="utf-8"))


def bound(name: str) -> float:
    """The bound of that check."""
    return float(CHECKS[name]["bound"])
