"""What drivers are declared to filter to."""

from __future__ import annotations

import tomllib
from pathlib import Path

from targets import Device

DECLARED = tomllib.loads((Path(__file__).parent / "filtering.toml").read_text("utf-8"))["driver"]


def declared(device: Device) -> float | None:
    """Largest error of lookups relative to the largest texel; None for a driver that is not listed."""
    told = f"{device.driver} {device.device}"
    return next((float(row["bound"]) for row in DECLARED if row["driver"] in told), None)
