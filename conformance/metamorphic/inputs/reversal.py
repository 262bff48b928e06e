"""A direction reversed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from codegen.ir.nodes import Function
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Inputs


def reverse(parameter: str) -> Callable[[Function, Inputs, Choice], dict[str, Any]]:
    """t -> -t, which is exact."""

    def change(function: Function, inputs: Inputs, choice: Choice) -> dict[str, Any]:
        return {**inputs, parameter: -np.asarray(inputs[parameter])}

    return change
