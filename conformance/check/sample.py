"""Random points and hard cases of a function as one set of inputs: few evaluations of many lanes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.check.draws import Draw, length


@dataclass(frozen=True)
class Sample:
    """Inputs of several draws one after another.

    inputs  parameter name -> array, structs as dicts
    draws   where they come from, without their inputs
    family  (N,) index of each lane's draw
    """

    inputs: dict[str, Any]
    draws: tuple[Draw, ...]
    family: npt.NDArray[np.intp]

    @property
    def lanes(self) -> int:
        return len(self.family)

    @property
    def families(self) -> tuple[str, ...]:
        return tuple(d.family for d in self.draws)

    @property
    def uniform(self) -> npt.NDArray[np.bool_]:
        """Mask of the random points of the domain."""
        return np.asarray(self.family == self.families.index("uniform"))

    def where(self, lane: int) -> str:
        """The family of a lane."""
        return self.families[int(self.family[lane])]

    def origin(self, lane: int) -> tuple[Draw, int]:
        """The draw that a lane comes from, without its inputs, and the lane's number in it."""
        first = int(np.argmax(self.family == self.family[lane]))
        return self.draws[int(self.family[lane])], lane - first


def together(draws: Iterable[Draw]) -> Sample:
    """All draws as one; ValueError where there is none."""
    parts = list(draws)
    if not parts:
        raise ValueError("nothing was drawn")
    return Sample(
        {name: _joined([d.inputs[name] for d in parts]) for name in parts[0].inputs},
        tuple(Draw(d.family, d.count, d.seed, {}) for d in parts),
        np.repeat(np.arange(len(parts)), [length(d.inputs) for d in parts]),
    )


def _joined(values: list[Any]) -> Any:
    if isinstance(values[0], Mapping):
        return {name: _joined([v[name] for v in values]) for name in values[0]}
    return np.concatenate(values)


def rows(inputs: Any, lanes: npt.NDArray[Any]) -> Any:
    """Some lanes of inputs or results."""
    if isinstance(inputs, Mapping):
        return {name: rows(value, lanes) for name, value in inputs.items()}
    return inputs[lanes]
