"""Inputs and values as text: decimal with all digits that matter, and the float32 words in hex."""

from __future__ import annotations

from typing import Any

import numpy as np


def one(value: Any, lane: int) -> str:
    """One lane of a value: `0.1 [3dcccccd]`, `(0, 0.6, 0.8) [00000000 3f19999a 3f4ccccd]`, `{x: ...}`."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {one(v, lane)}" for name, v in value.items()) + "}"
    element = np.asarray(value)[lane]
    parts = np.atleast_1d(element)
    decimals = ", ".join(f"{p:.9g}" if parts.dtype.kind == "f" else str(p) for p in parts)
    if parts.dtype == np.float64:
        return decimals if element.ndim == 0 else f"({decimals})"
    words = (
        " ".join(f"{w:08x}" for w in parts.astype(parts.dtype).view(np.uint32)) if parts.itemsize == 4 else ""
    )
    shown = decimals if element.ndim == 0 else f"({decimals})"
    return f"{shown} [{words}]" if words else shown


def lane_inputs(inputs: dict[str, Any], lane: int) -> str:
    """All inputs of one lane."""
    return ", ".join(f"{name} = {one(value, lane)}" for name, value in inputs.items())
