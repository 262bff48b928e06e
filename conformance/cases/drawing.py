"""Inputs for a function: its hard-case families, the ends of its domains, or uniform over the domains."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import Any
from zlib import crc32

import numpy as np
import numpy.typing as npt

from conformance.cases import background, domains, table
from conformance.cases.family import Family, Points, Role
from conformance.cases.parameters import Column, Leaf, leaves, nested
from conformance.cases.registry import FAMILIES
from conformance.cases.stream import Stream

UNIFORM = "uniform"
DOMAIN_ENDS = "domain_ends"
"""Not stored: the ends of the parameters' own domains, with their ULP neighbours."""
ENDS_SHARE = 0.75
MIXED_SHARE = 0.5

Binding = tuple[Leaf | None, ...]
"""For each role of a family the parameter that takes it; None for an optional role without one."""


def load(name: str) -> Points:
    """The stored points of a family by role; KeyError names the families there are."""
    if name not in FAMILIES:
        raise KeyError(f"no stored family {name!r}; there are {', '.join(FAMILIES)}")
    return table.read(FAMILIES[name])


def candidates(role: Role, found: list[Leaf]) -> list[Leaf | None]:
    """Parameters that fit the role."""
    fitting: list[Leaf | None] = [leaf for leaf in found if role.fits(leaf.name, leaf.type, leaf.unit)]
    return fitting or ([None] if role.optional else [])


def bindings(family: Family, found: list[Leaf]) -> list[tuple[Binding, npt.NDArray[np.intp]]]:
    """Ways to hand the roles to parameters, each with the points inside those parameters' domains."""
    points = table.read(family)
    ways: list[tuple[Binding, npt.NDArray[np.intp]]] = []
    seen: set[frozenset[Leaf | None]] = set()
    for binding in itertools.product(*(candidates(role, found) for role in family.roles)):
        if len(set(binding)) < len(binding) or (family.unordered and frozenset(binding) in seen):
            continue
        seen.add(frozenset(binding))
        bound = [(role, leaf) for role, leaf in zip(family.roles, binding, strict=True) if leaf is not None]
        inside = [domains.contains(leaf.domain, points[role.name]) for role, leaf in bound]
        rows = np.flatnonzero(np.logical_and.reduce(inside))
        if len(rows):
            ways.append((binding, rows))
    return ways


def families_for(parameters: Iterable[Any]) -> list[str]:
    """Names of the families that can feed a function with these parameters, `domain_ends` first."""
    found = leaves(parameters)
    return [DOMAIN_ENDS, *(name for name, family in FAMILIES.items() if bindings(family, found))]


def coverage(function: Any, family: str) -> int:
    """Number of inputs after which `draw` has used every point with every fitting parameter; 0: no such."""
    if family in (UNIFORM, DOMAIN_ENDS):
        return 0
    ways = bindings(FAMILIES[family], leaves(function.parameters))
    return len(ways) * max((len(rows) for _, rows in ways), default=0)


def draw(function: Any, family: str, n: int, seed: int = 0) -> dict[str, Any]:
    """n inputs by parameter name: float32, int32, uint32 or bool arrays (n,) or (n, k), structs as dicts.

    `function` has a `name` and `parameters` (name, type, domain). The same arguments give the same numbers.
    A stored family is spread evenly over the parameters that it fits; the other parameters are mixed from
    uniform values and ends of their domains. KeyError for a family that is unknown or does not fit.
    """
    stream = Stream(seed, crc32(str(function.name).encode()), crc32(family.encode()))
    found = leaves(function.parameters)
    if family == UNIFORM:
        values = {leaf.path: background.uniform(stream, leaf, n) for leaf in found}
    elif family == DOMAIN_ENDS:
        values = {leaf.path: background.mixed(stream, leaf, n, ENDS_SHARE) for leaf in found}
    else:
        ways = bindings(FAMILIES[family], found) if family in FAMILIES else []
        if not ways:
            raise KeyError(f"{function.name}: no family {family!r} for its parameters")
        values = {leaf.path: background.mixed(stream, leaf, n, MIXED_SHARE) for leaf in found}
        overwrite(values, FAMILIES[family], ways, stream, n)
    inputs = nested(values)
    background.related(inputs)
    return inputs


def overwrite(
    values: dict[tuple[str, ...], Column],
    family: Family,
    ways: list[tuple[Binding, npt.NDArray[np.intp]]],
    stream: Stream,
    n: int,
) -> None:
    """Put the family's points into the lanes: binding k takes lanes k, k + ways, ..., its points shuffled."""
    points = table.read(family)
    for first, (binding, rows) in enumerate(ways):
        lanes = np.arange(first, n, len(ways))
        order = rows[stream.permutation(len(rows))]
        chosen = order[np.arange(len(lanes)) % len(order)]
        for role, leaf in zip(family.roles, binding, strict=True):
            if leaf is not None:
                column = np.asarray(values[leaf.path]).copy()
                column[lanes] = points[role.name][chosen]
                values[leaf.path] = column
