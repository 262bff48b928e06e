"""Which reflectances are factored, and how: plan.toml as values."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from codegen.factors.homomorphic import Factors, Settings, factorise
from codegen.factors.samples import Samples
from codegen.factors.source import draw_samples
from codegen.library import Library, load_library

FOLDER = Path(__file__).parent
FORMS = FOLDER / "direct_forms"
"""Sources of the direct functions, parsed as a section of their own and never part of the library."""


@dataclass(frozen=True)
class Fit:
    """One factorisation of the plan; see plan.toml."""

    name: str
    function: str
    set: Mapping[str, float]
    p: int
    q: int
    r: int = 0
    diffuse: float = 0.0
    angles: str = "along"
    emphasis: float = 0.0
    direct: tuple[str, ...] = field(default=())

    def settings(self) -> Settings:
        """What the fit is made with."""
        return Settings(self.p, self.q, self.r, angles=self.angles, emphasis=self.emphasis)

    def drawn(self, library: Library, count: int, seed: int) -> Samples:
        """Samples of the reflectance."""
        return draw_samples(library, self.function, self.set, count, diffuse=self.diffuse, seed=seed)

    def factors(self, library: Library, samples: int) -> Factors:
        """The fit."""
        return factorise(self.drawn(library, samples, 1), self.settings())


@dataclass(frozen=True)
class Plan:
    """All fits; samples that are fitted, fresh ones that judge; the least z of what is judged by itself."""

    samples: int
    fresh: int
    above: float
    fits: tuple[Fit, ...]


def read_plan(path: Path = FOLDER / "plan.toml") -> Plan:
    """The plan of the file."""
    told = tomllib.loads(path.read_text(encoding="utf-8"))
    fits = [Fit(**{**entry, "direct": tuple(entry.get("direct", ()))}) for entry in told["fit"]]
    return Plan(told["samples"], told["fresh"], told["above"], tuple(fits))


def library() -> Library:
    """Our library with the direct functions."""
    return load_library(extra=(FORMS,))
