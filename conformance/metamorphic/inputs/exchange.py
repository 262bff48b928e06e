"""Two parameters exchanged: reciprocity."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from codegen.ir.nodes import Function
from conformance.fuzz.choices import Choice
from conformance.metamorphic.relation import Inputs


def exchange(first: str, second: str) -> Callable[[Function, Inputs, Choice], dict[str, Any]]:
    """Exchange two inputs."""

    def change(function: Function, inputs: Inputs, choice: Choice) -> dict[str, Any]:
        return {**inputs, first: inputs[second], second: inputs[first]}

    return change
