"""All vectors turned or mirrored together: by signed permutations of the axes, or by an angle."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from codegen.evaluate.arrays import Array
from codegen.ir.nodes import Function
from codegen.ir.types import VEC3, Struct, Type
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Ends, Inputs

QUARTER_TURN = ((2, -1.0), (0, 1.0), (1, -1.0))
"""Component k of the result is sign * component `source`: a proper rotation."""
MIRROR = ((0, 1.0), (1, -1.0), (2, 1.0))
ANGLE = 0.7390851332151607
"""Of the general rotation, about the axis (1, 1, 1): no component stays what it was."""

OPPOSED_SQUARE = 4.0e-12
"""Of |l + v|^2: half_vector falls back on an axis of its own where it is below 1e-12, its rounding aside."""

Axes = tuple[tuple[int, float], ...]


def permuted(axes: Axes, a: Array) -> Array:
    """A vector (N, 3) with its components permuted and negated."""
    return np.stack([a[:, source] * a.dtype.type(sign) for source, sign in axes], axis=-1)


def opposed(inputs: Inputs) -> Array:
    """Mask of the lanes whose light and viewer are opposite: what halves them turns with nothing."""
    directions = [np.asarray(inputs[name], np.float64) for name in ("l", "v") if name in inputs]
    if len(directions) < 2:
        return np.zeros(1, np.bool_)
    return np.asarray(np.sum(sum(directions) ** 2, axis=-1) < OPPOSED_SQUARE)


def _on_directions(type_: Type, value: Any, change: Any, units: bool) -> Any:
    """A value with every vec3 of it changed, except colours, which have an interval as their domain."""
    if isinstance(type_, Struct):
        return {f.name: _on_directions(f.type, value[f.name], change, _turns(f.domain)) for f in type_.fields}
    return change(value) if type_ == VEC3 and units else value


def _turns(domain: Any) -> bool:
    return type(domain).__name__ in ("Unit", "Length")


def axes_input(axes: Axes) -> Any:
    """Permute the components of every direction."""

    def change(function: Function, inputs: Inputs, choice: Choice) -> dict[str, Any]:
        return {
            p.name: _on_directions(p.type, inputs[p.name], lambda a: permuted(axes, a), _turns(p.domain))
            for p in function.parameters
        }

    return change


def axes_result(axes: Axes, turns: bool) -> Any:
    """The result permuted alike where it is a direction; scalars and colours stay."""

    def change(function: Function, ends: Ends) -> Ends:
        if not turns or function.returns != VEC3:
            return ends
        low, high = ends
        assert isinstance(low, np.ndarray)
        assert isinstance(high, np.ndarray)
        first, second = permuted(axes, low), permuted(axes, high)
        return np.minimum(first, second), np.maximum(first, second)

    return change


def rotation() -> Array:
    """The matrix of the general rotation."""
    axis = np.ones(3) / math.sqrt(3.0)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.asarray(np.eye(3) + math.sin(ANGLE) * cross + (1.0 - math.cos(ANGLE)) * cross @ cross)


def rotated(a: Array) -> Array:
    """A vector turned by the general rotation, rounded to float32."""
    return np.asarray((a.astype(np.float64) @ rotation().T).astype(np.float32))


def rotation_input(function: Function, inputs: Inputs, choice: Choice) -> dict[str, Any]:
    """Turn every direction by the general rotation."""
    return {
        p.name: _on_directions(p.type, inputs[p.name], rotated, _turns(p.domain)) for p in function.parameters
    }


def kept(function: Function, ends: Ends) -> Ends:
    """The result of a function of angles alone."""
    return ends
