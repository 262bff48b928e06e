"""Vectors made of their components."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


def stacked(columns: Sequence[Array], axis: int = -1) -> Array:
    """Vectors from their components, component after component in memory: operations of numpy then run along
    the lanes, three to four times as fast as along a vector."""
    assert axis == -1
    shapes = {a.shape for a in columns}
    shape = shapes.pop() if len(shapes) == 1 else np.broadcast_shapes(*(a.shape for a in columns))
    found = np.empty((len(columns), *shape), np.result_type(*columns))
    for k, a in enumerate(columns):
        found[k] = a
    return found.transpose(*range(1, found.ndim), 0)
