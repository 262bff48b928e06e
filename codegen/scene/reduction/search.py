"""The search for a cheaper function within the budget: variants of the library at call sites.

From the exact function on, the substitution that saves most is taken whose predicted error, of everything
together, stays within the budget; then the next, until none fits. A second order, by saving per error, guards
against one dear step that leaves no room for two good ones; the better end is kept.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from codegen.ir import nodes as ir
from codegen.library import Library
from codegen.scene.general import General
from codegen.scene.proof.errors import Measured, Reference
from codegen.scene.reduction.prices import Prices
from codegen.scene.reduction.sites import Choices, Copies, Known, Path, Site, sites, substituted

Rank = Callable[[float, Callable[[], Measured]], float]
"""What an offer is worth by what it saves and by the joint error, which is computed where it is asked for."""

SMALLEST_SAVING = 1e-3
"""Share of the model's price below which a substitution is not worth its error."""


@dataclass(frozen=True)
class Substitution:
    """One variant taken: where, what for what, what it saves by its price, and the error up to here."""

    path: Path
    caller: str
    old: str
    new: str
    saving: float
    together: float
    refused: tuple[str, ...] = ()


@dataclass(frozen=True)
class Found:
    """The choices of a search with their joint error."""

    choices: dict[Path, str]
    steps: tuple[Substitution, ...]
    error: Measured
    saving: float
    refused: bool = False


@dataclass
class Search:
    """Searches one scene; errors are computed once for all targets.

    known  ranges of the model's scalar parameters and struct fields
    """

    library: Library
    general: General
    reference: Reference
    known: Known
    _errors: dict[tuple[bool, tuple[tuple[Path, str], ...]], Measured] = field(default_factory=dict)
    _copies: Copies = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.screen = self.reference.screen()

    @property
    def model(self) -> ir.Function:
        """The shading function, whose call sites are searched."""
        return self.library.function(self.general.model)

    def error(self, choices: Choices, *, screened: bool = False) -> Measured:
        """The joint error of choices, made for every light; over few points where that will do."""
        key = screened, tuple(sorted(choices.items()))
        if key not in self._errors:
            reference = self.screen if screened else self.reference
            self._errors[key] = reference.error(*self.made(choices))
        return self._errors[key]

    def differ(self, choices: Choices, others: Choices) -> bool:
        """Whether two sets of choices give different values at one of the few points."""
        one, other = (self.screen.values(*self.made(c)) for c in (choices, others))
        return not np.array_equal(one, other)

    def made(self, choices: Choices) -> tuple[Library, str]:
        """The library with the general function that these choices give, and that function's name."""
        functions = self.functions(choices, "scene_candidate")
        return self.library.with_functions(functions), functions[-1].name

    def functions(self, choices: Choices, name: str) -> list[ir.Function]:
        """The general function with the choices made in the model of every light."""
        root = self.general.function
        everywhere = {(k, *path): new for k in self.general.model_calls for path, new in choices.items()}
        return substituted(self.library, root, everywhere, name, self._copies)

    def find(self, prices: Prices, budget: float, settled: frozenset[str] = frozenset()) -> Found:
        """The cheapest function within the budget that either order finds.

        settled  functions that become multiplications where their exponent is a whole number
        """
        by_saving = self._climb(prices, budget, settled, lambda saving, joint: saving)
        if not by_saving.refused:
            return by_saving
        by_error = self._climb(
            prices, budget, settled, lambda saving, joint: saving / max(joint().largest, 1e-3 * budget)
        )
        return max((by_saving, by_error), key=lambda found: (found.saving, -found.error.largest))

    def _climb(
        self,
        prices: Prices,
        budget: float,
        settled: frozenset[str],
        rank: Rank,
    ) -> Found:
        choices: dict[Path, str] = {}
        steps: list[Substitution] = []
        least = SMALLEST_SAVING * prices.scale * prices.weight(self.model.name)
        refused = False
        while budget > 0.0:
            offers = [
                (self._saving(prices, site, option), site, option)
                for site in sites(self.library, self.model, choices, self.known, settled)
                for option in site.options
            ]
            worth = [offer for offer in offers if offer[0] > least]
            step = self._first_that_fits(worth, choices, budget, rank)
            if step is None:
                refused = refused or bool(worth)
                break
            refused = refused or bool(step.refused)
            choices = _taken(choices, step.path, step.new)
            steps = [s for s in steps if s.path[: len(step.path)] != step.path]
            steps.append(step)
        total = sum(step.saving for step in steps)
        return Found(choices, tuple(steps), self.error(choices), total, refused)

    def _saving(self, prices: Prices, site: Site, option: str) -> float:
        """What an option saves, at most the price of the function whose text holds the call."""
        return min(prices.saving(site.callee, option), prices.price(site.caller))

    def _first_that_fits(
        self,
        offers: list[tuple[float, Site, str]],
        choices: dict[Path, str],
        budget: float,
        rank: Rank,
    ) -> Substitution | None:
        """The best offer whose joint error fits, with the better ones that do not."""
        ranked = []
        for saving, site, option in offers:
            taken = _taken(choices, site.path, option)
            worth = rank(saving, partial(self.error, taken, screened=True))
            ranked.append((worth, saving, taken, site, option))
        ranked.sort(key=lambda entry: (-entry[0], entry[3].path, entry[4]))
        refused: list[str] = []
        for _, saving, taken, site, option in ranked:
            joint = self.error(taken, screened=True)
            if joint.fits(budget):
                joint = self.error(taken)
            if joint.fits(budget):
                return Substitution(
                    site.path, site.caller, site.callee, option, saving, joint.largest, tuple(refused)
                )
            refused.append(f"{option} for {site.callee}: {joint.largest:.2g}")
        return None


def _taken(choices: Choices, path: Path, option: str) -> dict[Path, str]:
    """The choices with one more; what was chosen below a replaced call is void."""
    kept = {p: name for p, name in choices.items() if p[: len(path)] != path}
    return {**kept, path: option}
