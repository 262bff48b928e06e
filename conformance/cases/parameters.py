"""A function's parameters, structs taken apart; read by attribute, nothing of the generator is imported."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

FRAME_FIELDS = ("tangent", "bitangent", "normal")


@dataclass(frozen=True)
class Leaf:
    """A parameter or field that holds numbers: where it is, its type (f32, vec3, ..., Frame), its domain."""

    path: tuple[str, ...]
    type: str
    domain: Any = field(compare=False)

    @property
    def name(self) -> str:
        """The parameter's or field's own name."""
        return self.path[-1]

    @property
    def unit(self) -> bool:
        """Whether it is a unit vector."""
        return type(self.domain).__name__ == "Unit"


def type_name(type_: Any) -> str:
    """vec3 for the type of that name, given as a text or as an object with a name."""
    return str(getattr(type_, "name", type_))


def leaves(parameters: Iterable[Any], path: tuple[str, ...] = ()) -> list[Leaf]:
    """All leaves in order. An orthonormal frame stays whole: its three vectors are not free."""
    found: list[Leaf] = []
    for parameter in parameters:
        place = (*path, str(parameter.name))
        fields = getattr(parameter.type, "fields", None)
        if fields is None:
            found.append(Leaf(place, type_name(parameter.type), parameter.domain))
        elif tuple(field.name for field in fields) == FRAME_FIELDS:
            found.append(Leaf(place, "Frame", None))
        else:
            found += leaves(fields, place)
    return found


def value_of(leaf: Leaf, inputs: Mapping[str, Any]) -> Any:
    """What inputs hold of a leaf; a frame's three vectors side by side, (N, 9)."""
    value: Any = inputs
    for name in leaf.path:
        value = value[name]
    return np.concatenate([value[name] for name in FRAME_FIELDS], axis=1) if leaf.type == "Frame" else value


def nested(values: dict[tuple[str, ...], Any]) -> dict[str, Any]:
    """Values by path as nested dicts, the shape in which executors and references take them."""
    result: dict[str, Any] = {}
    for path, value in values.items():
        place = result
        for name in path[:-1]:
            place = place.setdefault(name, {})
        place[path[-1]] = value
    return result


Column = npt.NDArray[Any] | dict[str, npt.NDArray[np.float32]]
