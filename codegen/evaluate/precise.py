"""The namespace of mpmath arithmetic: numpy's names over arrays of mpf, at mpmath's current precision."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt

from codegen.evaluate.textures import lookup_in, size_in
from codegen.evaluate.vectors import stacked

Array = npt.NDArray[Any]


def _divide(a: Any, b: Any) -> Any:
    """a / b, with IEEE's values where b is 0: lanes that a branch does not take get here."""
    if b != 0:
        return a / b
    if a == 0 or mpmath.isnan(a):
        return mpmath.nan
    return mpmath.inf if a > 0 else mpmath.ninf


def namespace() -> SimpleNamespace:
    """The op registry's names over object arrays of mpf, as precise as mpmath is set when they are called."""

    def each(function: Callable[..., Any], arity: int = 1) -> Callable[..., Any]:
        found: Callable[..., Any] = np.frompyfunc(function, arity, 1)
        return found

    def to_precise(x: Array) -> Array:
        return np.asarray(
            each(mpmath.mpf)(np.asarray(x, np.uint32).view(np.float32).astype(np.float64)), dtype=object
        )

    return SimpleNamespace(
        abs=each(abs),
        minimum=each(min, 2),
        maximum=each(max, 2),
        floor=each(mpmath.floor),
        divide=each(_divide, 2),
        sqrt=each(lambda x: mpmath.sqrt(x) if x >= 0 else mpmath.nan),
        exp=each(mpmath.exp),
        exp2=each(lambda x: mpmath.power(2, x)),
        log=each(lambda x: mpmath.log(x) if x > 0 else mpmath.mpf("-inf")),
        log2=each(lambda x: mpmath.log(x, 2) if x > 0 else mpmath.mpf("-inf")),
        sin=each(mpmath.sin),
        cos=each(mpmath.cos),
        arctan2=each(mpmath.atan2, 2),
        stack=stacked,
        lookup_level=lookup_in(np.object_, each(mpmath.floor), mpmath.mpf),
        texture_size=size_in(np.object_, mpmath.mpf),
        logical_and=np.logical_and,
        logical_or=np.logical_or,
        logical_not=np.logical_not,
        float_to_bits=lambda x: np.asarray(np.asarray(x, np.float64), np.float32).view(np.uint32),
        bits_to_float=to_precise,
    )
