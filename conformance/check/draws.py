"""What a function is checked on: random points, the worst inputs found so far, families of hard cases."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from codegen.errors import UserError
from codegen.ir.nodes import Function
from conformance import cases

UNIFORM_COUNT = 20_000
"""Random points per function where no other number is asked for."""
FAMILY_COUNT = 2_000
"""Most points taken from one family of hard cases."""
SEED = 20_260
"""Seed of the random points; stated in every replay identity."""


@dataclass(frozen=True)
class Draw:
    """One named set of inputs."""

    family: str
    count: int
    seed: int
    inputs: dict[str, Any]


def draws(function: Function, uniform: int = UNIFORM_COUNT, family: int = FAMILY_COUNT) -> Iterable[Draw]:
    """Random points, the worst inputs that searches found, every family that fits the parameters."""
    for name, count in [
        ("uniform", uniform),
        *([(cases.WORST, 0)] if cases.has_worst(function) else []),
        *((f, family) for f in cases.families_for(function.parameters)),
    ]:
        yield draw(function, name, count, SEED)


def draw(function: Function, family: str, count: int, seed: int) -> Draw:
    """One set of inputs, the same for the same arguments; raises UserError for a function that reads maps."""
    if function.reads_textures:
        raise UserError(f"{function.name} reads maps: tests in conformance/execute look at it")
    inputs = cases.worst(function) if family == cases.WORST else cases.draw(function, family, count, seed)
    return Draw(family, count if family == "uniform" else length(inputs), seed, inputs)


def only_lane(whole: Draw, lane: int) -> Draw:
    """The draw cut down to one lane."""

    def cut(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: cut(v) for name, v in value.items()}
        return value[lane : lane + 1]

    return replace(whole, inputs=cut(whole.inputs))


def length(inputs: Mapping[str, Any]) -> int:
    """Number of lanes of the inputs."""
    first = next(iter(inputs.values()))
    return length(first) if isinstance(first, Mapping) else len(first)
