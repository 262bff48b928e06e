"""Values as rows of scalars, one row per scalar and one column per lane: what a kit and its results hold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.ir.nodes import Function
from codegen.ir.types import leaves

Words = npt.NDArray[np.uint32]

RESULT = "result"
"""Name of the row of a result that is one scalar."""


@dataclass(frozen=True)
class Row:
    """One scalar: its path (`l.x`, `optics.exponent`) and its type, one of f32, i32, u32 and bool."""

    path: str
    type: str


def input_rows(function: Function) -> tuple[Row, ...]:
    """The scalars of all parameters, in the order in which a harness numbers them."""
    return tuple(
        Row(p.name + path, scalar.name) for p in function.parameters for path, scalar in leaves(p.type)
    )


def result_rows(function: Function) -> tuple[Row, ...]:
    """The scalars of the result."""
    return tuple(Row(path.lstrip(".") or RESULT, scalar.name) for path, scalar in leaves(function.returns))


def columns(value: Any) -> list[npt.NDArray[Any]]:
    """The rows of a value in the shapes of codegen.evaluate.evaluate, whatever its numbers are."""
    if isinstance(value, Mapping):
        return [row for part in value.values() for row in columns(part)]
    a = np.asarray(value)
    return [a[:, k] for k in range(a.shape[1])] if a.ndim == 2 else [a]


def hexadecimal(words: Sequence[int] | Words) -> list[str]:
    """32-bit words as eight digits each."""
    return [f"{int(word):08x}" for word in words]
