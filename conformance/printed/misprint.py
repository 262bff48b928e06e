"""One misprint: what the slide says, what is right, and how far apart the two are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from codegen.evaluate import evaluate
from codegen.library import load_library
from conformance.printed.places import Array, Places, ball, direction, pairs

N = direction(0, 0)
"""The surface normal of every example."""
TIE = 1e-9
"""Relative; of equally bad places the first is named, whatever the last bits say."""

Pair = tuple[Array, Array]
"""The right and the printed values, (N,) or linear RGB (N, 3)."""
Quantity = Callable[[Array, Array], Pair]
"""From places (N, k) and directions to the light (1, 3) or (N, 3)."""


def value(name: str, **inputs: Any) -> Any:
    """A function of the library in float64; parameters are arrays of rows, single rows or single numbers."""
    return evaluate(load(), name, {key: _rows(x) for key, x in inputs.items()}, "float64")


@cache
def load() -> Any:
    """The library, read once."""
    return load_library()


@dataclass(frozen=True)
class Drawing:
    """What a picture shows.

    scale    values from the dark to the bright end of the palette; None for colours
    marks    label -> direction (1, 3) drawn into the hemisphere
    ball     values over the normals of a ball seen from z, in place of those over the hemisphere
    limit    end of the scale of differences; None for the largest difference
    shows    what the value is, in a few words
    samples  values per pixel, along each side
    """

    shows: str
    scale: tuple[float, float] | None = (0.0, 1.0)
    marks: tuple[tuple[str, Array], ...] = ()
    ball: Quantity | None = None
    limit: float | None = None
    samples: int = 2


@dataclass(frozen=True)
class Misprint:
    """One misprint with its example.

    key        name of its picture
    title      what is misprinted
    slide      the slide's heading
    printed    the slide's formula
    right      the right formula
    effect     what it does, in a sentence or two
    setting    parameters of the example
    over       what runs over the places: v, l, n or d
    places     where it is measured
    quantity   right and printed values
    light      direction to the light (1, 3) of the example, where that is a second direction
    functions  printed functions of the library that are measured here
    parts      label -> right and printed values with one of several misprints alone
    unbounded  whether the error has no bound
    """

    key: str
    title: str
    slide: str
    printed: str
    right: str
    effect: str
    setting: str
    over: str
    places: Places
    quantity: Quantity
    drawing: Drawing
    light: Array | None = None
    functions: tuple[str, ...] = ()
    parts: tuple[tuple[str, Quantity], ...] = ()
    unbounded: bool = False


@dataclass(frozen=True)
class Error:
    """Absolute errors over the places: the largest, the weighted mean, where, and how often above 1."""

    largest: float
    mean: float
    where: str
    above_one: float


def measure(misprint: Misprint, quantity: Quantity | None = None) -> Error:
    """Error of the printed form (or of one of its parts) in the example."""
    places = misprint.places
    error = distance((quantity or misprint.quantity)(places.points, _light(misprint)))
    worst = int(np.argmax(error >= error.max() * (1.0 - TIE)))
    above = float(places.weights[error > 1.0].sum())
    return Error(float(error.max()), float(places.weights @ error), places.name(worst), above)


def measure_every_light(misprint: Misprint, quantity: Quantity | None = None) -> tuple[float, float] | None:
    """Largest and mean error over all pairs of hemispheres of l and v; None where l alone is varied."""
    if misprint.light is None:
        return None
    v, l, weights = pairs()
    error = distance((quantity or misprint.quantity)(v, l))
    return float(error.max()), float(weights @ error)


def distance(pair: Pair) -> Array:
    """Absolute error (N,); of colours the largest component."""
    error = np.abs(pair[1] - pair[0])
    return np.asarray(error.max(axis=1) if error.ndim == 2 else error)


def drawn(misprint: Misprint, x: Array, y: Array) -> Pair:
    """Right and printed values at points of the unit disc."""
    if misprint.drawing.ball is not None:
        return misprint.drawing.ball(ball(x, y), _light(misprint))
    return misprint.quantity(misprint.places.disc(x, y), _light(misprint))


def _light(misprint: Misprint) -> Array:
    return N if misprint.light is None else misprint.light


def _rows(x: Any) -> Any:
    if isinstance(x, dict):
        return {key: _rows(part) for key, part in x.items()}
    return np.atleast_1d(np.asarray(x, dtype=np.float64))
