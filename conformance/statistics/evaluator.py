"""A lobe as three callables on arrays, whoever computes them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Call = Callable[[str, Mapping[str, Any]], Any]
"""Evaluates a named function on inputs by parameter name; returns an array."""


@dataclass(frozen=True)
class LobeEvaluator:
    """One lobe with fixed parameters. Directions are (N, 3), pairs u (N, 2); results come back as float64.

    name        for messages, with the parameters
    call        evaluates <lobe>_value, <lobe>_pdf and <lobe>_sample
    lobe        name of the lobe
    parameters  parameter name -> value
    """

    name: str
    call: Call
    lobe: str
    parameters: Mapping[str, float]

    def value(self, l: Array, v: Array) -> Array:
        """Reflectance per steradian, (N,)."""
        return self._run("value", l=l, v=v)

    def pdf(self, l: Array, v: Array) -> Array:
        """Density per steradian of l, (N,)."""
        return self._run("pdf", l=l, v=v)

    def density(self, v: Array) -> Callable[[Array], Array]:
        """The density of l for one view v (3,), as a function of directions (N, 3)."""
        return lambda l: self.pdf(l, v)

    def sample(self, u: Array, v: Array) -> Array:
        """Directions (N, 3)."""
        return self._run("sample", u=u, v=v)

    def _run(self, part: str, **arguments: Array) -> Array:
        rows = len(next(iter(arguments.values())))
        inputs = {name: _rows(x, rows) for name, x in arguments.items()}
        inputs |= {name: np.full(rows, value) for name, value in self.parameters.items()}
        result = np.asarray(self.call(f"{self.lobe}_{part}", inputs), dtype=np.float64)
        if not np.isfinite(result).all():
            raise AssertionError(
                f"{self.name}: {part} is not finite in {np.sum(~np.isfinite(result))} places"
            )
        return result


def lobe_evaluator(call: Call, lobe: str, parameters: Mapping[str, float]) -> LobeEvaluator:
    """The lobe evaluated by `call`, with a readable name."""
    values = ", ".join(f"{key} {value:g}" for key, value in parameters.items())
    return LobeEvaluator(f"{lobe} ({values})", call, lobe, parameters)


def reference_call(references: Mapping[str, Callable[..., Any]]) -> Call:
    """Evaluates float64 references by keyword."""

    def call(name: str, inputs: Mapping[str, Any]) -> Any:
        return references[name](**inputs)

    return call


def view(polar_degrees: float, azimuth_degrees: float) -> Array:
    """Unit vector at a polar angle from z and an azimuth from x, (3,)."""
    polar, azimuth = np.radians(polar_degrees), np.radians(azimuth_degrees)
    return np.array([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])


def grid_pairs(count: int, seed: int) -> Array:
    """Uniform random pairs on the grid k 2^-24 that float32 samplers are given, (count, 2)."""
    words = np.random.Generator(np.random.Philox(seed)).integers(0, 1 << 24, (count, 2))
    return np.asarray(words * 2.0**-24, dtype=np.float64)


def shifted_sets(count: int, sets: int, seed: int) -> list[Array]:
    """Independent random shifts of one R2 point set, on the grid k 2^-24: `sets` arrays (count, 2)."""
    steps = np.array([3242174889, 2447445413], dtype=np.uint64)
    index = np.arange(count, dtype=np.uint64)[:, None]
    words = ((index * steps) & np.uint64(0xFFFFFFFF)) >> np.uint64(8)
    shifts = np.random.Generator(np.random.Philox(seed)).integers(0, 1 << 24, (sets, 2), dtype=np.uint64)
    return [((words + shift) & np.uint64(0xFFFFFF)).astype(np.float64) * 2.0**-24 for shift in shifts]


def _rows(x: Array | Sequence[float], rows: int) -> Array:
    """One vector for all rows, or a vector for each."""
    given = np.asarray(x, dtype=np.float64)
    return np.tile(given, (rows, 1)) if given.ndim == 1 else given
