"""Red, green and blue permuted in every colour."""

from __future__ import annotations

from typing import Any

import numpy as np

from codegen.evaluate.arrays import Array
from codegen.ir.domains import Interval
from codegen.ir.nodes import Function
from codegen.ir.types import VEC3, Struct, Type
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Ends, Inputs

ORDER = (2, 0, 1)


def _permuted(a: Array) -> Array:
    return np.ascontiguousarray(a[:, ORDER])


def _colours(type_: Type, domain: Any, value: Any) -> Any:
    if isinstance(type_, Struct):
        return {f.name: _colours(f.type, f.domain, value[f.name]) for f in type_.fields}
    return _permuted(value) if type_ == VEC3 and _is_colour(domain) else value


def _is_colour(domain: Any) -> bool:
    """A vec3 whose components are numbers from 0 on; texels of a tangent map have negative ones, too."""
    return isinstance(domain, Interval) and domain.low >= 0.0


def permute_inputs(function: Function, inputs: Inputs, choice: Choice) -> dict[str, Any]:
    """Permute the channels of every colour."""
    return {p.name: _colours(p.type, p.domain, inputs[p.name]) for p in function.parameters}


def permute_result(function: Function, ends: Ends) -> Ends:
    """The channels of the result permuted alike."""
    low, high = ends
    assert isinstance(low, np.ndarray)
    assert isinstance(high, np.ndarray)
    return _permuted(low), _permuted(high)
