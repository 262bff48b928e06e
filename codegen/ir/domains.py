"""Domains that signatures state: what a parameter may be. Read by docs, sampling and analyses."""

from __future__ import annotations

from dataclasses import dataclass

SCALES = ("linear", "log")


@dataclass(frozen=True)
class Interval:
    """A number (or every component of a vector) in [low, high].

    `scale` says how to sample it, linearly or by magnitude ("log"); by magnitude, random points start at
    `least` (0: as small as any), while tests of the ends still use `low`.
    """

    low: float
    high: float
    scale: str = "linear"
    least: float = 0.0

    def describe(self) -> str:
        return f"in [{number(self.low)}, {number(self.high)}]"


@dataclass(frozen=True)
class Unit:
    """A unit vector (up to float32 rounding of its length)."""

    def describe(self) -> str:
        return "unit vector"


@dataclass(frozen=True)
class Length:
    """A vector of any direction whose length is 0 or in [low, high]."""

    low: float
    high: float

    def describe(self) -> str:
        return f"length in [{number(self.low)}, {number(self.high)}]"


@dataclass(frozen=True)
class Finite:
    """Any finite value of the type."""

    def describe(self) -> str:
        return "finite"


@dataclass(frozen=True)
class Edges:
    """How a map goes on beyond its edges along u and v: "repeat" or "clamp". The host's sampler does that."""

    u: str
    v: str

    def describe(self) -> str:
        return f"linear filter within and between levels; {self.u} in u, {self.v} in v"


EDGES = ("repeat", "clamp")
Domain = Interval | Unit | Length | Finite | Edges
MARKERS: dict[str, type[Interval] | type[Unit] | type[Length] | type[Finite] | type[Edges]] = {
    "Interval": Interval,
    "Unit": Unit,
    "Length": Length,
    "Finite": Finite,
    "Edges": Edges,
}


def number(value: float) -> str:
    """A number as a person writes it: 0, 1, 0.5, 1e-30, 100000."""
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    text = f"{value:.9g}"
    return text.replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")
