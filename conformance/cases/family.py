"""A family of hard cases: a table of float32 (or u32) points and the parameters it can stand in for."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from conformance.cases.stream import Stream

Points = dict[str, npt.NDArray[Any]]
"""Role -> float32 (N,), float32 (N, k) or uint32 (N,)."""


@dataclass(frozen=True)
class Role:
    """One column group of a family; a parameter fits by type, by being a unit vector or not, and by name."""

    name: str
    type: str = "vec3"
    unit: bool = True
    pattern: str = ".*"
    optional: bool = False

    def fits(self, name: str, type_: str, unit: bool) -> bool:
        """Whether a parameter of that name and type may take this role."""
        return type_ == self.type and unit == self.unit and re.search(self.pattern, name) is not None


@dataclass(frozen=True)
class Family:
    """Hard cases of one kind. `unordered`: roles may be exchanged, so one order of parameters suffices."""

    name: str
    roles: tuple[Role, ...]
    what: str
    why: str
    points: Callable[[Stream], Points]
    unordered: bool = False


def direction(name: str, pattern: str | None = None) -> Role:
    """A unit vector; by default only the parameter of exactly that name."""
    return Role(name, pattern=f"^{name}$" if pattern is None else pattern)


def scalar(name: str, pattern: str | None = None, optional: bool = False, type_: str = "f32") -> Role:
    """A number; by default only the parameter of exactly that name."""
    return Role(name, type_, False, f"^{name}$" if pattern is None else pattern, optional)


PAIR = (direction("a", ".*"), direction("b", ".*"))
"""Any two directions of a function."""
TRIPLE = (direction("t"), direction("l"), direction("v"))
EXPONENT = r"(^|_)exponent|^p(_|$)"
"""Names of exponents: exponent, primary_exponent, exponent_x, p, p_diffuse ..."""
