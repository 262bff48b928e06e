"""What functions are held to beside their declared bounds: further_bounds.toml and codomains.toml."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from codegen.bounds import Bound, read_bounds
from codegen.library import Library

PATH = Path(__file__).with_name("further_bounds.toml")
CODOMAINS = Path(__file__).with_name("codomains.toml")


@cache
def further_bounds() -> dict[str, list[Bound]]:
    """Function -> its further bounds."""
    return read_bounds(PATH.name, tomllib.loads(PATH.read_text(encoding="utf-8")))


def with_further_bounds(library: Library) -> Library:
    """The library, its functions held to their further bounds, too."""
    for name, bounds in further_bounds().items():
        library.bounds[name] = [*library.bounds.get(name, ()), *bounds]
    return library


@cache
def codomains() -> dict[str, tuple[float, float]]:
    """Function -> the smallest and the largest result that its source promises."""
    data = tomllib.loads(CODOMAINS.read_text(encoding="utf-8"))
    return {name: (float(low), float(high)) for name, (low, high) in data.items()}


def leaves_codomain(name: str, value: Any) -> bool:
    """Whether any result of a function lies outside its codomain; never for functions without one."""
    if name not in codomains():
        return False
    low, high = codomains()[name]
    a = np.asarray(value)
    return not bool(np.all((a >= low) & (a <= high)))
