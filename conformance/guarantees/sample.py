"""Random points and hard cases of a function as one set of inputs: few evaluations of many lanes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.check.engine import Draw


@dataclass(frozen=True)
class Sample:
    """Inputs of several draws one after another.

    inputs    parameter name -> array, structs as dicts
    families  names of the families
    family    (N,) index of each lane's family
    """

    inputs: dict[str, Any]
    families: tuple[str, ...]
    family: npt.NDArray[np.intp]

    @property
    def lanes(self) -> int:
        return len(self.family)

    @property
    def uniform(self) -> npt.NDArray[np.bool_]:
        """Mask of the random points of the domain."""
        return np.asarray(self.family == self.families.index("uniform"))

    def where(self, lane: int) -> str:
        """The family of a lane."""
        return self.families[int(self.family[lane])]


def together(draws: Iterable[Draw]) -> Sample:
    """All draws as one."""
    parts = list(draws)
    return Sample(
        {name: _joined([d.inputs[name] for d in parts]) for name in parts[0].inputs},
        tuple(d.family for d in parts),
        np.repeat(np.arange(len(parts)), [d.count for d in parts]),
    )


def _joined(values: list[Any]) -> Any:
    if isinstance(values[0], Mapping):
        return {name: _joined([v[name] for v in values]) for name in values[0]}
    return np.concatenate(values)


def rows(inputs: Any, lanes: npt.NDArray[Any]) -> Any:
    """Some lanes of inputs."""
    if isinstance(inputs, Mapping):
        return {name: rows(value, lanes) for name, value in inputs.items()}
    return inputs[lanes]
