"""The accuracy that the library promises at named places, measured on one driver.

sin_angle on pairs of directions at angles from 1e-1 to 1e-7 rad, near b = a and b = -a, once rounded to
float32 and once normalised in float32; strand_specular and strand_azimuth_cosine on uniform and hard
directions.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.ir.domains import Interval
from codegen.library import Library
from conformance.bench.accuracy import widened
from conformance.cases.stream import F32, Stream, normalised_single, single, tilted
from conformance.check import measure
from conformance.check.engine import Backend, draws
from conformance.check.features import applies
from conformance.reference import ambiguous, reference_for

SEED = 20_262
ANGLES = tuple(float(f"1e-{k}") for k in range(1, 8))
SINE_GOAL = 5e-7
SPECULAR_GOALS: dict[float, float | None] = {1e3: 5e-6, 1e4: 1.5e-5, 1e5: None}
"""Largest exponent -> largest absolute error."""
AZIMUTH_GOAL = 1e-6
AZIMUTH_ANGLE = 1e-4
"""Smallest angle between the strand and the other directions, in radians."""


@dataclass(frozen=True)
class Figure:
    """One promised figure.

    what      the quantity
    domain    where it was measured
    driver    on what; empty where no driver takes part
    goal      largest value allowed; None where none is promised
    measured  the value
    unit      of both; for errors "absolute" or "relative"
    """

    what: str
    domain: str
    driver: str
    goal: float | None
    measured: float
    unit: str

    @property
    def met(self) -> bool | None:
        """Whether the goal is reached; None without one."""
        return None if self.goal is None else bool(self.measured <= self.goal)

    def as_data(self) -> dict[str, Any]:
        """Plain data."""
        return {**asdict(self), "met": self.met}


def device_figures(library: Library, on: Backend, count: int) -> list[Figure]:
    """All figures of one driver, with this many random points each."""
    found: list[Figure] = []
    if "sin_angle" in library.public:
        found += _sines(library, on, count)
    if "strand_specular" in library.public:
        found += _speculars(library, on, count)
    if "strand_azimuth_cosine" in library.public:
        found.append(_azimuth(library, on, count))
    return found


def _sines(library: Library, on: Backend, count: int) -> list[Figure]:
    found, spoiled = [], 0
    for normalised in (False, True):
        for k, angle in enumerate(ANGLES):
            a, b = pairs(Stream(SEED, k, normalised), angle, count, normalised)
            where = {"angle(a, b)": (ANGLES[-1], 2.0)}
            error, bad = _largest(library, on, "sin_angle", "relative", [{"a": a, "b": b}], where)
            spoiled += bad
            how = "normalised in float32" if normalised else "rounded to float32"
            domain = f"{angle:g} rad from +-a, {how}"
            found.append(Figure("sin_angle", domain, on.target, SINE_GOAL, error, "relative"))
    domain = "all of these pairs"
    return [*found, Figure("sin_angle", domain, on.target, 0.0, float(spoiled), "not finite")]


def pairs(stream: Stream, angle: float, count: int, normalised: bool) -> tuple[F32, F32]:
    """Directions a and b, alternately this angle from a and from -a.

    normalised  vectors of lengths 1e-2 to 1e2, normalised in float32, instead of rounded unit vectors
    """
    a = stream.directions(count)
    b = tilted(a, stream.across(a), angle) * np.where(np.arange(count) % 2, -1.0, 1.0)[:, None]
    if not normalised:
        return single(a), single(b)
    lengths = [10.0 ** stream.uniform(count, -2.0, 2.0)[:, None] for _ in range(2)]
    return normalised_single(a * lengths[0]), normalised_single(b * lengths[1])


def _speculars(library: Library, on: Backend, count: int) -> list[Figure]:
    function = library.function("strand_specular")
    found = []
    for high, goal in SPECULAR_GOALS.items():
        domain = Interval(1.0, high, scale="log")
        parameters = tuple(
            replace(p, domain=domain) if p.name == "exponent" else p for p in function.parameters
        )
        sets = [d.inputs for d in draws(replace(function, parameters=parameters), count)]
        error, _ = _largest(library, on, function.name, "absolute", sets, {"exponent": (1.0, high)})
        text = f"exponent 1 to {high:g}, every direction"
        found.append(Figure(function.name, text, on.target, goal, error, "absolute"))
    return found


def _azimuth(library: Library, on: Backend, count: int) -> Figure:
    function = library.function("strand_azimuth_cosine")
    where = {f"angle({x}, t)": (AZIMUTH_ANGLE, 2.0) for x in ("l", "v")}
    sets = [d.inputs for d in draws(function, count)]
    error, _ = _largest(library, on, function.name, "absolute", sets, where)
    domain = f"light and viewer from {AZIMUTH_ANGLE:g} rad off the strand"
    return Figure(function.name, domain, on.target, AZIMUTH_GOAL, error, "absolute")


def _largest(
    library: Library,
    on: Backend,
    name: str,
    how: str,
    sets: Iterable[dict[str, npt.NDArray[Any]]],
    where: dict[str, tuple[float, float]],
) -> tuple[float, int]:
    """Largest error inside the domain, and the number of results anywhere that are not finite."""
    judge = Bound(name, how, 0.0, "", "", where=where)
    largest, spoiled = 0.0, 0
    for inputs in sets:
        got = on.run(library, name, inputs)
        spoiled += int((~measure.finite(got)).sum())
        inside = applies(judge, inputs, len(next(iter(inputs.values())))) & ~ambiguous(name, inputs)
        if inside.any():
            expected = reference_for(name)(*(widened(v) for v in inputs.values()))
            largest = max(largest, float(measure.error(judge, got, expected)[inside].max()))
    return largest, spoiled
