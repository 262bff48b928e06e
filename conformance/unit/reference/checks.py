"""The tolerances of conformance/reference_checks.toml."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[1] / "reference_checks.toml"
CHECKS: dict[str, Any] = tomllib.loads(FILE.read_text(encoding="utf-8"))


def bound(name: str) -> float:
    """The bound of that check."""
    return float(CHECKS[name]["bound"])
