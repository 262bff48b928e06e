"""Features of inputs that bounds speak of: numbers, angle(x, y), apart(x, y), dot(x, y), length(x)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.errors import UserError, nearest

Array = npt.NDArray[Any]
_CALL = re.compile(r"^(angle|apart|dot|length)\(([\w.]+)(?:, *([\w.]+))?\)$")


def lookup(inputs: Mapping[str, Any], path: str) -> Array:
    """An input, a struct field or a vector's component by its dotted path, in float64."""
    value: Any = inputs
    for part in path.split("."):
        if isinstance(value, np.ndarray) and value.ndim == 2 and part in tuple("xyzw"[: value.shape[1]]):
            value = value[:, "xyzw".index(part)]
            continue
        if not isinstance(value, Mapping) or part not in value:
            valid = value if isinstance(value, Mapping) else ()
            raise UserError(f'a bound speaks of an unknown input "{path}"{nearest(part, valid)}')
        value = value[part]
    return np.asarray(value, np.float64)


def feature(inputs: Mapping[str, Any], text: str) -> Array:
    """The feature's value per lane.

    angle(x, y) is the angle between x and the line of y, in [0, pi/2]; apart(x, y) is |x - y| of two numbers.
    """
    call = _CALL.match(text)
    if call is None:
        return lookup(inputs, text)
    kind, first, second = call.groups()
    a = lookup(inputs, first)
    if kind == "length":
        return np.asarray(np.linalg.norm(a, axis=-1))
    b = lookup(inputs, second)
    if kind == "apart":
        return np.asarray(np.abs(a - b))
    if kind == "dot":
        return np.asarray(np.sum(a * b, axis=-1))
    # Products of float32 numbers are exact in float64, so that a plain cross product keeps small angles.
    area = np.linalg.norm(np.cross(a, b), axis=-1)
    return np.asarray(np.arctan2(area, np.abs(np.sum(a * b, axis=-1))))


def applies(bound: Bound, inputs: Mapping[str, Any], count: int) -> npt.NDArray[np.bool_]:
    """Mask of the lanes inside the bound's domain."""
    mask = np.ones(count, np.bool_)
    for text, (low, high) in bound.where.items():
        value = feature(inputs, text)
        mask &= (value >= low) & (value <= high)
    return mask
