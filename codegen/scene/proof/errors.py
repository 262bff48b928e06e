"""How far a function is from another over points: absolute, largest component."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Value
from codegen.evaluate.memory import Memory
from codegen.library import Library
from codegen.scene.proof.points import Inputs, Points

Floats = npt.NDArray[np.float64]
MARGIN = 1.15
"""A predicted error has to fit the budget this many times: drivers round and approximate in their own ways,
and points are not every input."""


@dataclass(frozen=True)
class Measured:
    """Largest and 99.9 % error over points, in absolute units, and the point of the largest."""

    largest: float
    p999: float
    worst: int
    finite: bool

    def fits(self, budget: float) -> bool:
        """Whether a prediction fits a budget, with the margin."""
        return self.finite and self.largest * MARGIN <= budget

    def within(self, budget: float) -> bool:
        """Whether it fits a budget as it is."""
        return self.finite and self.largest <= budget


def as_floats(value: Value) -> Floats:
    """A scalar or vector result, (N, size), widened."""
    assert not isinstance(value, dict)
    a = np.asarray(value, np.float64)
    return a[:, None] if a.ndim == 1 else a


def distance(got: Floats, *references: Floats) -> Measured:
    """The distance of results to the nearest of the references, lane by lane."""
    finite = bool(np.isfinite(got).all())
    with np.errstate(all="ignore"):
        apart = functools.reduce(np.minimum, [_largest(np.abs(got - r)) for r in references])
    apart = np.where(np.isfinite(apart), apart, np.inf)
    worst = int(np.argmax(apart))
    place = math.ceil(0.999 * (len(apart) - 1))  # a value that occurs: an error may be infinite
    p999 = np.partition(apart, place)[place]
    return Measured(float(apart[worst]), float(p999), worst, finite)


def _largest(a: Floats) -> Floats:
    """The largest component of each row: over few columns much faster than along an axis."""
    found: Floats = functools.reduce(np.maximum, a.T)
    return found


def reference_values(library: Library, name: str, points: Points) -> tuple[Floats, Floats]:
    """A function of the library over points: in float64, and as float32 rounds it."""
    return exact_values(library, name, points), as_floats(evaluate(library, name, points.inputs, "float32"))


def exact_values(library: Library, name: str, points: Points) -> Floats:
    """A function of the library over points in float64."""
    return as_floats(evaluate(library, name, points.inputs, "float64"))


SCREEN = 2_500
"""Points that a candidate is tried on before all of them are asked."""


@dataclass(frozen=True)
class Reference:
    """The general function's values over points: in float64, and as float32 rounds it.

    Where inputs are at a jump or at a cancellation the two differ; a result counts as right if it is near
    either.
    """

    points: Points
    exact: Floats
    single: Floats
    memory: Memory | None = field(default=None, repr=False, compare=False)

    @staticmethod
    def of(
        library: Library, name: str, points: Points, exact: Callable[[], Floats] | None = None
    ) -> Reference:
        """The reference of a function of the library, remembering what functions like it share with it.

        exact  gives its values in float64 where they are computed elsewhere
        """
        memory = Memory()
        single = as_floats(evaluate(library, name, points.inputs, "float32", memory=memory))
        wide = exact_values(library, name, points) if exact is None else exact()
        return Reference(points, wide, single, memory)

    @property
    def rounding(self) -> float:
        """How far float32 takes the general function itself off at ordinary points: the 99.9 % error."""
        ordinary = ~self.points.hard
        return distance(self.single[ordinary], self.exact[ordinary]).p999

    def screen(self) -> Reference:
        """The same over the first few points, where candidates that are much alike share their work."""
        points = self.points
        few = Points(first(points.inputs, SCREEN), min(SCREEN, points.count), points.hard[:SCREEN])
        return Reference(few, self.exact[:SCREEN], self.single[:SCREEN], Memory())

    def values(self, library: Library, name: str) -> Floats:
        """The values of another function of some of the parameters, evaluated in float32."""
        given = {p.name: self.points.inputs[p.name] for p in library.function(name).parameters}
        return as_floats(evaluate(library, name, given, "float32", memory=self.memory))

    def error(self, library: Library, name: str) -> Measured:
        """How far another function is."""
        return distance(self.values(library, name), self.exact, self.single)


def first(inputs: Inputs, count: int) -> Inputs:
    """The first lanes of inputs."""
    return {name: np.asarray(value)[:count] for name, value in inputs.items()}
