"""Whether loops over lanes are compiled: where numba is installed, from so many lanes on that it pays."""

from __future__ import annotations

import functools
from types import ModuleType
from typing import Any

from codegen.intervals.numbers import Array

FEWEST = 1024
"""Lanes from which on a compiled loop is worth its call, and its compilation."""


def wanted(lanes: int) -> bool:
    """Whether an operation over so many lanes runs as a compiled loop."""
    return lanes >= FEWEST and found() is not None


@functools.cache
def found() -> ModuleType | None:
    """The compiled loops, None without numba: imported when first wanted, since numba takes a second."""
    try:
        from codegen.intervals import kernels
    except ImportError:
        return None
    return kernels


def kernels() -> ModuleType:
    """The compiled loops, where they are wanted."""
    loops = found()
    assert loops is not None
    return loops


def ends(low: Array, high: Array) -> tuple[Any, Any]:
    """Both ends as operands of a loop: as numbers where all lanes share them."""
    return (low, high) if len(low) > 1 else (float(low[0]), float(high[0]))
