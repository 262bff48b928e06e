"""Shading of a visibility buffer by one function of the library, on any backend."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError, nearest
from conformance.picture.scene import Light, Range, Scene, Value
from conformance.picture.vectors import unit
from conformance.picture.visibility import Singles, Visibility

SAMPLES_AT_ONCE = 1 << 18
FROM_PICTURE = ("n", "t", "map_tangent", "v", "l", "h", "light")
"""Parameters that differ from sample to sample or belong to a light; all others come from the scene."""

Doubles = npt.NDArray[np.float64]
Evaluate = Callable[[str, Mapping[str, Any]], npt.NDArray[Any]]
"""The value (N, 3) of a function for arrays by parameter name."""


@dataclass(frozen=True)
class Backend:
    """Something that evaluates functions of the library: its name, the driver behind it, and how."""

    name: str
    driver: str
    evaluate: Evaluate


@dataclass(frozen=True)
class Slot:
    """A parameter of the shading function, or one field of a struct.

    name    as in the source, dotted for a field
    width   1 for a number, 2 to 4 for a vector
    bounds  the interval in which its components lie; None where the signature states none
    """

    name: str
    width: int
    bounds: tuple[float, float] | None = None


@dataclass(frozen=True)
class Models:
    """The shading functions of a library: their names, and the parameters of one, flattened."""

    names: tuple[str, ...]
    slots: Callable[[str], tuple[Slot, ...]]


@dataclass(frozen=True)
class Shading:
    """A function of the library with the values of all parameters that the picture does not supply."""

    function: str
    slots: tuple[Slot, ...]
    values: dict[str, tuple[float, ...]]

    def inputs(self, arrays: Mapping[str, Singles], rows: slice) -> dict[str, Any]:
        """Arrays by parameter name for some samples; structs are dicts, constants are repeated."""
        count = len(arrays["n"][rows])
        found: dict[str, Any] = {}
        for slot in self.slots:
            if slot.name in arrays:
                array = arrays[slot.name][rows]
            else:
                constant = np.array(self.values[slot.name], dtype=np.float32)
                array = np.broadcast_to(constant, (count, slot.width)).copy()
                array = array[:, 0] if slot.width == 1 else array
            owner, _, name = slot.name.rpartition(".")
            (found.setdefault(owner, {}) if owner else found)[name] = array
        return found


def bind(scene: Scene, models: Models) -> Shading:
    """Match a scene's model and parameters with the library's shading functions."""
    function = _function(scene, models.names)
    slots = models.slots(function)
    wanted = {slot.name: slot for slot in slots if slot.name not in FROM_PICTURE}
    where = f"{scene.path}: [parameters]"
    for name in scene.parameters:
        if name in FROM_PICTURE:
            raise UserError(f'{where} "{name}": is supplied by the picture for every sample')
        if name not in wanted:
            hint = nearest(name, wanted)
            raise UserError(f'{where} "{name}": {function} has no such parameter{hint}')
    values = {}
    for name, slot in wanted.items():
        if name not in scene.parameters:
            raise UserError(f'{where} "{name}": is missing; {function} needs it')
        values[name] = _components(scene.parameters[name])
        if len(values[name]) != slot.width:
            kind = "a number" if slot.width == 1 else f"a vector of {slot.width} numbers"
            raise UserError(f'{where} "{name}": must be {kind}')
        low, high = slot.bounds or (-np.inf, np.inf)
        if not all(low <= x <= high for x in _extremes(scene.parameters[name])):
            raise UserError(f'{where} "{name}": must lie in [{low:g}, {high:g}], where {function} is defined')
    return Shading(function, slots, values)


def shade(backend: Backend, shading: Shading, seen: Visibility, lights: tuple[Light, ...]) -> Doubles:
    """Linear light (N, 3) of the covered samples: the function's value, times colour, over the lights.

    The function itself is all that a backend computes; the sum over the lights is taken in float64.
    """
    total = np.zeros((len(seen.n), 3))
    colour_inside = any(slot.name == "light" for slot in shading.slots)
    for light, l, lit in zip(lights, seen.l, seen.lit, strict=True):
        colour = np.array(light.colour, dtype=np.float32)
        arrays: dict[str, Singles] = {
            "n": seen.n,
            "t": seen.t,
            "map_tangent": seen.map_tangent,
            "v": seen.v,
            "l": l,
            "h": unit(l + seen.v).astype(np.float32),
            "light": np.broadcast_to(colour, l.shape),
        }
        factor = lit[:, None].astype(np.float64) * (1.0 if colour_inside else colour.astype(np.float64))
        for start in range(0, len(total), SAMPLES_AT_ONCE):
            rows = slice(start, start + SAMPLES_AT_ONCE)
            value = backend.evaluate(shading.function, shading.inputs(arrays, rows))
            total[rows] += factor[rows] * value
    return total


def _function(scene: Scene, names: tuple[str, ...]) -> str:
    for name in (scene.model, f"{scene.model}_shade"):
        if name in names:
            return name
    short = [name.removesuffix("_shade") for name in names]
    hint = nearest(scene.model, short)
    raise UserError(f'{scene.path}: [shade] model: no shading function is called "{scene.model}"{hint}')


def _components(value: Value | Range) -> tuple[float, ...]:
    if isinstance(value, Range):
        return (value.middle,)
    return value if isinstance(value, tuple) else (value,)


def _extremes(value: Value | Range) -> tuple[float, ...]:
    return (value.low, value.high) if isinstance(value, Range) else _components(value)
