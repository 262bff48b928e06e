"""What stages hand to a shading function, as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.fur.shading import SCALED, FurShading


def shading_inputs(
    shading: FurShading,
    material: Mapping[str, Any],
    given: Mapping[str, Any],
    count: int,
    scales: Mapping[str, npt.NDArray[Any]] | None = None,
) -> dict[str, Any]:
    """Inputs of a shading function for `count` points.

    given   what differs from point to point or belongs to a light, by parameter; the rest is left out
    scales  length_share and density_share of a coat, (count,)
    """
    needed = {p.name for p in shading.function.parameters}
    inputs: dict[str, Any] = {name: repeated(x, count) for name, x in given.items() if name in needed}
    for slot in shading.material:
        constant = tuple(np.atleast_1d(material[slot.path]))
        value = repeated(constant if len(constant) > 1 else constant[0], count)
        if scales is not None and slot.path in SCALED:
            value = value * scales[SCALED[slot.path]]
        owner, _, field = slot.path.rpartition(".")
        (inputs.setdefault(owner, {}) if owner else inputs)[field] = value
    return inputs


def repeated(value: Any, count: int) -> npt.NDArray[Any]:
    """Arrays as they are, in float32; a number or a tuple `count` times."""
    array = np.asarray(value)
    array = array.astype(np.float32) if array.dtype.kind == "f" else array
    if isinstance(value, np.ndarray) and array.ndim:
        return array
    return np.broadcast_to(array, (count, *array.shape)).copy()
