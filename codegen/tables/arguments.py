"""Which two arguments a table of a library function has, and the function of just these two."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError, unknown
from codegen.evaluate import evaluate
from codegen.ir.domains import Interval
from codegen.ir.nodes import Function
from codegen.ir.types import F32, VEC3
from codegen.library import Library
from codegen.tables.axes import Axis

Array = npt.NDArray[np.float64]
Evaluated = Callable[[Array, Array], Array]

AXIS_NAMES = ("t", "n")
"""The direction that cosines are taken with, where a function has one of these."""
AZIMUTHS = (0.0, 1.0, 2.5)
"""Angles between the planes of two directions, in radians, at which a function must give the same value."""
AGREEMENT = 1e-6
"""How far values at these azimuths may differ before the function counts as one of three arguments."""


def two_arguments(
    library: Library,
    name: str,
    held: Mapping[str, float],
    ranges: Mapping[str, tuple[float, float]] | None = None,
) -> tuple[Axis, Axis, Evaluated]:
    """The axes of a function's two free arguments, and its values in float64 over arrays of them.

    A number with an interval is an argument. Two directions beside t or n are arguments by their cosines with
    it, if the value depends on nothing else.

    held    values of the other parameters
    ranges  narrower intervals of the arguments, by their names as axes

    raises  UserError for a function that has not two such arguments
    """
    function = library.function(name)
    if function.returns != F32:
        raise UserError(f"{name}: a table holds numbers, and this function returns no number")
    numbers = {p.name: p for p in function.parameters if p.type == F32}
    for key in held:
        if key not in numbers:
            raise unknown(f"parameter of {name}", key, numbers)
    for key, value in held.items():
        domain = numbers[key].domain
        if isinstance(domain, Interval) and not domain.low <= value <= domain.high:
            raise UserError(f"{name}: {key} = {value:g} is not {domain.describe()}")
    free = [p for p in function.parameters if p.name not in held]
    if len(free) == 2 and all(p.type == F32 for p in free):
        axes = []
        for p in free:
            if not isinstance(p.domain, Interval):
                raise UserError(f"{name}: {p.name} has no interval that a table could cover")
            axes.append(Axis(p.name, p.domain.low, p.domain.high))
        x, y = _narrowed(name, axes, ranges or {})
        return x, y, _of_numbers(library, name, held, x.name, y.name)
    directions = [p.name for p in free if p.type == VEC3]
    axis = next((a for a in AXIS_NAMES if a in directions), None)
    others = [d for d in directions if d != axis]
    if axis is None or len(others) != 2 or len(directions) != len(free):
        listed = ", ".join(p.name for p in free)
        raise UserError(f"{name} has the open arguments {listed}; a table has two: hold the others by --set")
    axes = [Axis(f"{axis}.{other}", -1.0, 1.0) for other in others]
    x, y = _narrowed(name, axes, ranges or {})
    return x, y, _of_cosines(library, function, held, axis, others)


def _narrowed(name: str, axes: list[Axis], ranges: Mapping[str, tuple[float, float]]) -> tuple[Axis, Axis]:
    by_name = {a.name: a for a in axes}
    for key, (low, high) in ranges.items():
        if key not in by_name:
            raise unknown(f"argument of {name}", key, by_name)
        whole = by_name[key]
        if not whole.low <= low < high <= whole.high:
            raise UserError(
                f"{name}: the range {low:g}:{high:g} of {key} is no part of [{whole.low:g}, {whole.high:g}]"
            )
        by_name[key] = Axis(key, low, high)
    x, y = by_name.values()
    return x, y


def _of_numbers(library: Library, name: str, held: Mapping[str, float], x: str, y: str) -> Evaluated:
    def value(a: Array, b: Array) -> Array:
        constants = {key: np.full(a.shape, number) for key, number in held.items()}
        return np.asarray(evaluate(library, name, {x: a, y: b, **constants}, "float64"))

    return value


def _of_cosines(
    library: Library, function: Function, held: Mapping[str, float], axis: str, others: list[str]
) -> Evaluated:
    def at(a: Array, b: Array, azimuth: float) -> Array:
        sine_a, sine_b = np.sqrt(1.0 - a * a), np.sqrt(1.0 - b * b)
        inputs = {key: np.full(a.shape, number) for key, number in held.items()}
        inputs[axis] = np.tile([1.0, 0.0, 0.0], (len(a), 1))
        inputs[others[0]] = np.stack([a, sine_a, np.zeros_like(a)], axis=-1)
        inputs[others[1]] = np.stack([b, sine_b * np.cos(azimuth), sine_b * np.sin(azimuth)], axis=-1)
        return np.asarray(evaluate(library, function.name, inputs, "float64"))

    probe = np.linspace(-0.95, 0.95, 9)
    a, b = (grid.ravel() for grid in np.meshgrid(probe, probe))
    values = [at(a, b, azimuth) for azimuth in AZIMUTHS]
    if max(float(np.abs(v - values[0]).max()) for v in values) > AGREEMENT:
        raise UserError(
            f"{function.name} depends on the angle between {others[0]} and {others[1]} too, not only on "
            f"their cosines with {axis}; a table of two arguments cannot hold it"
        )
    return lambda a, b: at(a, b, AZIMUTHS[0])
