"""What a speed on a driver is, and how often it is measured; see codegen.scene.report.stopwatch."""

from __future__ import annotations

from dataclasses import dataclass

CHAINS = 4
"""Independent evaluations side by side."""
ROUNDS = 9


@dataclass(frozen=True)
class Speed:
    """Nanoseconds of one evaluation above its baseline: median and quartiles; seconds that building took."""

    ns: float
    low: float
    high: float
    build_seconds: float
