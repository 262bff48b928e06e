"""At which inputs a function computes normal numbers only.

A result below 2^-126 that is not 0 is denormal or flushed; CPUs take a hundred times as long for it, so that
a few such lanes decide the time of a measurement.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate.arrays import Value, arithmetic, convert_inputs
from codegen.evaluate.interpreter import Frame
from codegen.ir import nodes as ir
from codegen.ir.types import element_of
from codegen.library import Library

SMALLEST_NORMAL = 2.0**-126

Mask = npt.NDArray[np.bool_]


class _Watching(Frame):
    """An evaluation in float64, which holds what float32 does not, that notes lanes with tiny results."""

    normal: Mask

    def inner(self, function: ir.Function, inputs: dict[str, Value]) -> Frame:
        frame = _Watching(self.find, self.arithmetic, function, inputs, self.count)
        frame.normal = self.normal
        return frame

    def expr(self, e: ir.Expr) -> Value:
        value = super().expr(e)
        if isinstance(value, np.ndarray) and element_of(e.type).name == "f32":
            size = np.abs(value)
            tiny = (size > 0.0) & (size < SMALLEST_NORMAL)
            self.normal &= ~(tiny.any(axis=1) if tiny.ndim == 2 else tiny)
        return value


def normal_lanes(library: Library, name: str, inputs: Mapping[str, Any]) -> Mask:
    """Where no operation gives a number below 2^-126 but 0; both sides of branches count."""
    chosen, function = arithmetic("float64"), library.function(name)
    arrays, count = convert_inputs(
        {p.name: p.type for p in function.parameters}, inputs, chosen, function.name
    )
    frame = _Watching(library.function, chosen, function, arrays, count)
    frame.normal = np.ones(count, np.bool_)
    with np.errstate(all="ignore"):
        frame.run()
    return frame.normal
