"""Independent float64 references, one module per section of the library.

A module of this package may define two tables, which are joined here:
REFERENCES  name of a public function -> its value in float64, parameters in the library's order
AMBIGUOUS   name of a public function -> mask of the inputs at which rounding decides between two documented
            values, and which are therefore checked for finiteness only (see ambiguous.py)

Variants stand beside their base with the base's reference; a printed form has its own. Inputs are arrays of
the exact values that the shader got: scalars (N,), vectors (N, k), u32 as uint32; structs are dicts of them.
The references are written from the literature and share nothing with the library under test.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from conformance.reference import shells
from conformance.reference.exact import Mask

__all__ = ["PROPERTY_ONLY", "REFERENCES", "ambiguous", "reference_for"]


def joined(table: str) -> dict[str, Callable[..., Any]]:
    """The entries of that table in all modules; ValueError where two of them define one name."""
    entries: dict[str, Callable[..., Any]] = {}
    for name in sorted(info.name for info in pkgutil.iter_modules(__path__)):
        own: dict[str, Callable[..., Any]] = getattr(importlib.import_module(f"{__name__}.{name}"), table, {})
        twice = sorted(set(own) & set(entries))
        if twice:
            raise ValueError(f"{__name__}.{name}: {table} has {', '.join(twice)} a second time")
        entries.update(own)
    return entries


REFERENCES = joined("REFERENCES")
PREDICATES = joined("AMBIGUOUS")
PROPERTY_ONLY = shells.PROPERTY_ONLY
"""Functions that no formula fixes: tested by what they must do, and for agreement between targets."""


def reference_for(name: str, base: str | None = None) -> Callable[..., Any]:
    """The reference of a function, or of the base it is a variant of; KeyError where there is none."""
    for candidate in (name, base):
        if candidate in REFERENCES:
            return REFERENCES[candidate]
    raise KeyError(f"no reference for {name}")


def ambiguous(name: str, inputs: Mapping[str, Any], base: str | None = None) -> Mask:
    """Mask (N,) of the inputs that are checked for finiteness only; `inputs` by parameter name."""
    predicate = PREDICATES.get(name) or PREDICATES.get(base or name)
    if predicate is None:
        return np.zeros(count(inputs), dtype=np.bool_)
    return np.asarray(predicate(inputs), dtype=np.bool_)


def count(inputs: Mapping[str, Any]) -> int:
    """Number of rows; structs are looked into."""
    first = next(iter(inputs.values()))
    return count(first) if isinstance(first, Mapping) else len(first)
