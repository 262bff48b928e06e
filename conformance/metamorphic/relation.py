"""What a relation is: a second program or a second input whose result is known from the first one's."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from codegen.evaluate.arrays import Array, Value
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.fuzz.choices import Choice

Inputs = Mapping[str, Any]
Ends = tuple[Value, Value]


@dataclass(frozen=True)
class Changed:
    """A transformed function, values of the parameters that it has beyond the original's, and new callees."""

    function: Function
    added: Mapping[str, float] = field(default_factory=dict)
    callees: tuple[Function, ...] = ()


@dataclass(frozen=True)
class SourceRelation:
    """Rewrites a function into one with the same meaning; None where there is nothing to rewrite."""

    name: str
    what: str
    apply: Callable[[Function, Library, Choice], Changed | None]


@dataclass(frozen=True)
class InputRelation:
    """Changes inputs so that the result changes in a known way, or not at all.

    inputs      the other inputs, from a function's
    result      what the first result becomes; works on values and, with its ends, on intervals
    functions   the functions for which it holds
    is_exact    the changed inputs are exact: both sides mean one and the same real number
    tolerance   how far the two sides may differ in float64, relative to 1 + |value|
    silent      mask of the inputs of which the relation says nothing; None: there are none
    """

    name: str
    what: str
    functions: tuple[str, ...]
    inputs: Callable[[Function, Inputs, Choice], dict[str, Any]]
    result: Callable[[Function, Ends], Ends]
    is_exact: bool
    tolerance: float
    silent: Callable[[Inputs], Array] | None = None


def unchanged(function: Function, ends: Ends) -> Ends:
    """The result of a relation that does not change it."""
    return ends


def map_arrays(value: Any, change: Callable[[Array], Array]) -> Any:
    """A value with every array changed."""
    if isinstance(value, Mapping):
        return {name: map_arrays(v, change) for name, v in value.items()}
    return change(value)
