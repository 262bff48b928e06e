"""Kinds of accuracy that specifications promise for one operation, as values.

ULP is Muller's: the distance between the two floats around the exact value.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Exact:
    """The mathematical result, which is representable."""


@dataclass(frozen=True)
class Rounded:
    """Correctly rounded, to either neighbour unless the target says to nearest."""


@dataclass(frozen=True)
class Ulp:
    """Within `units` ULP; plus `per_abs_x` ULP for each unit of |x|."""

    units: float
    per_abs_x: float = 0.0


@dataclass(frozen=True)
class Absolute:
    """Within `bound`, promised for arguments in `within`; `elsewhere` outside it (None: nothing)."""

    bound: float
    within: tuple[float, float]
    elsewhere: Ulp | None = None


@dataclass(frozen=True)
class Inherited:
    """As accurate as the formula named, evaluated with the target's own operations."""

    formula: str


@dataclass(frozen=True)
class ScaledAbsolute:
    """Within `epsilons` * 2^-23 times the largest product of operand magnitudes."""

    epsilons: float


@dataclass(frozen=True)
class Unstated:
    """The specification promises nothing."""


Accuracy = Exact | Rounded | Ulp | Absolute | Inherited | ScaledAbsolute | Unstated
Promise = Mapping[str, Accuracy]

EXACT: Promise = {"wgsl": Exact(), "vulkan": Exact(), "glsl": Exact(), "opencl": Exact()}
ROUNDED: Promise = {"wgsl": Rounded(), "vulkan": Rounded(), "glsl": Rounded(), "opencl": Rounded()}


def promise(wgsl: Accuracy, opencl: Accuracy, glsl: Accuracy | None = None) -> Promise:
    """The usual case: Vulkan and OpenGL promise what WGSL does, unless OpenGL says otherwise."""
    return {"wgsl": wgsl, "vulkan": wgsl, "glsl": glsl or wgsl, "opencl": opencl}
