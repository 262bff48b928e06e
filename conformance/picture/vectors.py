"""Small vector arithmetic on arrays of directions, in the precision of its operands."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.floating[Any]]
F = TypeVar("F", bound=np.floating[Any])


def dot(a: npt.NDArray[F], b: npt.NDArray[F]) -> npt.NDArray[F]:
    """Scalar products (N,) of vectors (N, 3)."""
    product: npt.NDArray[F] = np.sum(a * b, axis=-1)
    return product


def unit(a: npt.NDArray[F]) -> npt.NDArray[F]:
    """The vectors (..., 3) divided by their lengths; a zero vector stays zero."""
    length = np.sqrt(np.sum(a * a, axis=-1, keepdims=True))
    result: npt.NDArray[F] = a / np.where(length > 0.0, length, np.ones_like(length))
    return result
