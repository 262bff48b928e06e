"""Populations of inputs: one array per leaf of the parameters, and the inputs that a function takes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.cases import background, domains
from conformance.cases.parameters import FRAME_FIELDS, Leaf, leaves, nested, value_of
from conformance.cases.stream import norm

Array = npt.NDArray[Any]
Mask = npt.NDArray[np.bool_]
Population = dict[tuple[str, ...], Array]
"""Path of a leaf -> (n,) or (n, components); an orthonormal frame is (n, 9)."""

ROUNDED_UNIT = 1.6e-7
"""How far rounding takes the length of a unit vector from 1.

Components rounded once: 6e-8. Normalised in float32, every operation rounded to nearest: 1.60e-7, the worst
of 8e6 vectors. A search that may go further finds nothing but the error of the lengths.
"""


def pack(found: Iterable[Leaf], inputs: Mapping[str, Any]) -> Population:
    """The population of these inputs."""
    return {leaf.path: np.array(value_of(leaf, inputs)) for leaf in found}


def unpack(found: Iterable[Leaf], population: Population) -> dict[str, Any]:
    """The inputs by parameter name, structs as dicts."""
    values: dict[tuple[str, ...], Any] = {}
    for leaf in found:
        value = population[leaf.path]
        if leaf.type == "Frame":
            parts = {name: value[:, 3 * k : 3 * k + 3] for k, name in enumerate(FRAME_FIELDS)}
            values[leaf.path] = parts
        else:
            values[leaf.path] = value
    return nested(values)


def related(function: Any, population: Population) -> Population:
    """The population with values that respect what is said of two parameters together."""
    found = leaves(function.parameters)
    inputs = unpack(found, population)
    background.related(inputs)
    return pack(found, inputs)


def take(population: Population, lanes: Array) -> Population:
    """Those lanes, in that order."""
    return {path: values[lanes] for path, values in population.items()}


def choose(mask: Mask, if_true: Population, if_false: Population) -> Population:
    """Lane by lane one of two populations."""
    return {path: pick(mask, if_true[path], if_false[path]) for path in if_true}


def pick(mask: Mask, if_true: Array, if_false: Array) -> Array:
    """Lane by lane one of two arrays."""
    return np.where(mask[:, None] if if_true.ndim == 2 else mask, if_true, if_false)


def join(parts: Iterable[Population]) -> Population:
    """Populations one after the other."""
    parts = list(parts)
    return {path: np.concatenate([part[path] for part in parts]) for path in parts[0]}


def valid(leaf: Leaf, values: Array) -> Mask:
    """Which lanes lie in the leaf's domain; unit vectors up to the rounding of their own components."""
    if leaf.type == "Frame":
        return np.ones(len(values), np.bool_)
    inside = domains.contains(leaf.domain, values)
    if leaf.unit:
        inside &= np.abs(norm(values.astype(np.float64)) - 1.0) <= ROUNDED_UNIT
    return inside
