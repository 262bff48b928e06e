"""Inputs multiplied by powers of two: every rounding happens in the same place."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from codegen.ir.nodes import Function
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Ends, Inputs, map_arrays


def scale(powers: Mapping[str, int]) -> Callable[[Function, Inputs, Choice], dict[str, Any]]:
    """Multiply each named input by 2 to its power."""

    def change(function: Function, inputs: Inputs, choice: Choice) -> dict[str, Any]:
        scaled = dict(inputs)
        for name, power in powers.items():
            scaled[name] = np.asarray(inputs[name]) * np.float32(2.0**power)
        return scaled

    return change


def scaled_result(power: int) -> Callable[[Function, Ends], Ends]:
    """The result multiplied by 2 to a power."""

    def change(function: Function, ends: Ends) -> Ends:
        low, high = (map_arrays(end, lambda a: a * a.dtype.type(2.0**power)) for end in ends)
        return low, high

    return change
