"""From the general function of a scene to the one that is written, for one target.

The exact passes come first and are kept as they are. With a budget, the cheaper forms follow, each only while
the error of everything together, predicted over points, stays within it: whole exponents by multiplication,
variants at call sites, looser forms of the geometry, numbers for terms that hardly vary.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from codegen.errors import UserError
from codegen.ir import nodes as ir
from codegen.library import Library
from codegen.passes.analysis.operations import operations
from codegen.passes.rules.powers import LARGEST
from codegen.passes.rules.sine_powers import EXPONENTS
from codegen.passes.specialise import Specialised, specialise
from codegen.passes.ssa.text import show
from codegen.scene.description.document import Scene
from codegen.scene.description.lights import UNROLLED
from codegen.scene.general import General
from codegen.scene.proof.errors import Floats, Measured, Reference
from codegen.scene.proof.points import Points
from codegen.scene.reduction.drops import Term, errors_without, parts_of, terms, without
from codegen.scene.reduction.knowledge import Knowledge, knowledge, model_ranges
from codegen.scene.reduction.loosen import BUNDLES, SPLAT, Form, loosened
from codegen.scene.reduction.prices import Prices
from codegen.scene.reduction.scales import gathered
from codegen.scene.reduction.search import Found, Search, Substitution
from codegen.scene.reduction.sites import Path

SMALLEST_GAIN = 0.005
"""Share of the price that a form has to save to be worth its error."""
MOST_DROPS = 4
WITNESSES = 50
"""Points that have to see the loss of a term: what hardly any point reaches is not judged by points."""


@dataclass(frozen=True)
class Change:
    """One approximation: what, why it is cheaper, and the predicted error of everything up to it.

    kind   variant, power, form or term
    brief  the same in few words, for the comment of the result
    """

    kind: str
    what: str
    why: str
    error: float
    saving: str = ""
    refused: tuple[str, ...] = ()
    brief: str = ""


@dataclass(frozen=True)
class Reduced:
    """What the search made of a scene for one target.

    exact    after exact passes only
    final    what is written; the same as exact where no approximation fits
    changes  the approximations in order
    error    predicted error of final, over the points of the search
    log      the steps of the exact passes
    """

    target: str
    exact: Specialised
    final: Specialised
    changes: tuple[Change, ...]
    error: Measured
    prices: str
    choices: dict[Path, str] = field(default_factory=dict)


class Chosen(NamedTuple):
    """Where a search stands before it changes forms: powers, variants, changes of powers."""

    powers: int
    found: Found
    changes: tuple[Change, ...]

    def same_as(self, other: Chosen) -> bool:
        """Whether the same functions are called."""
        return self.powers == other.powers and self.found.choices == other.found.choices


@dataclass
class Reducer:
    """Reduces one scene; what does not depend on the target is done once."""

    library: Library
    general: General
    knowledge: Knowledge
    reference: Reference
    search: Search
    name: str
    _made: dict[tuple[object, ...], Specialised] = field(default_factory=dict)
    _needed: dict[tuple[object, ...], dict[Path, str]] = field(default_factory=dict)
    _cleaned: dict[tuple[ir.Stmt, ...], Specialised] = field(default_factory=dict)
    _errors: dict[tuple[ir.Stmt, ...], Measured] = field(default_factory=dict)
    _screened: dict[tuple[ir.Stmt, ...], Measured] = field(default_factory=dict)
    _terms: dict[tuple[ir.Stmt, ...], list[tuple[Term, Measured]]] = field(default_factory=dict)
    _gathered: dict[tuple[ir.Stmt, ...], ir.Function | None] = field(default_factory=dict)
    _looser: dict[tuple[tuple[ir.Stmt, ...], str], ir.Function | None] = field(default_factory=dict)

    @staticmethod
    def of(
        library: Library,
        scene: Scene,
        general: General,
        points: Points | Callable[[], Points],
        exact: Callable[[], Floats] | None = None,
    ) -> Reducer:
        """The reducer of a scene over points of it; `library` holds the general function.

        points  may be waited for
        exact   waits for the function's values in float64, which another process computes meanwhile; None
                where they are computed here
        """
        name = general.function.name
        known = knowledge(scene, general)
        made: dict[tuple[object, ...], Specialised] = {}
        if exact is not None:
            try:
                made[(), 0] = known.specialised(library, name, scene.function)
            except UserError:
                if not isinstance(points, Points):
                    points()  # that there are none says more
                raise
        reference = Reference.of(library, name, points if isinstance(points, Points) else points(), exact)
        search = Search(library, general, reference, model_ranges(scene, general))
        return Reducer(library, general, known, reference, search, scene.function, made)

    def exact(self) -> Specialised:
        """The function after exact passes only."""
        return self.specialised({}, 0)

    def specialised(self, choices: dict[Path, str], powers: int) -> Specialised:
        """The general function with variants at call sites, specialised to what the scene knows."""
        key = (tuple(sorted(choices.items())), powers)
        if key not in self._made:
            library, name = self.library, self.general.function.name
            if choices:
                functions = self.search.functions(choices, f"{self.general.function.name}_chosen")
                library, name = library.with_functions(functions), functions[-1].name
            self._made[key] = self.knowledge.specialised(library, name, self.name, powers)
        return self._made[key]

    def chosen(self, prices: Prices, budget: float) -> Chosen:
        """The powers and variants for a target."""
        changes: list[Change] = []
        powers = self.powers(self.exact(), budget, changes)
        found = self.search.find(prices, budget, frozenset(EXPONENTS) if powers else frozenset())
        return Chosen(powers, found, tuple(changes))

    def reduced(self, prices: Prices, budget: float, chosen: Chosen | None = None) -> Reduced:
        """The cheapest function within the budget that the search finds for a target.

        chosen  its powers and variants, where they are known already
        """
        exact = self.exact()
        changes: list[Change] = []
        current, choices = exact, {}
        if budget > 0.0:
            powers, found, made = chosen or self.chosen(prices, budget)
            key = tuple(sorted(found.choices.items())), powers
            if key not in self._needed:
                self._needed[key] = self.needed(found.choices, powers)
            choices = self._needed[key]
            changes += [*made, *_variants(found, choices, prices)]
            current = self.specialised(choices, powers)
            current = self.loosened(current, prices, budget, changes)
            current = self.dropped(current, prices, budget, changes)
            current = self.gathered(current, prices, budget, changes)
        error = self.error(current)
        return Reduced(prices.target, exact, current, tuple(changes), error, prices.source, choices)

    def error(self, made: Specialised) -> Measured:
        """The error of a specialised function over the points, evaluated in float32."""
        body = made.function.body
        if body not in self._errors:
            library = self.library.with_functions([made.function])
            self._errors[body] = self.reference.error(library, made.function.name)
        return self._errors[body]

    def passes(self, function: ir.Function, budget: float) -> bool:
        """Whether the budget holds the error of a function over the few first points."""
        if function.body not in self._screened:
            library = self.library.with_functions([function])
            self._screened[function.body] = self.search.screen.error(library, function.name)
        return self._screened[function.body].fits(budget)

    def fits(self, made: Specialised, budget: float) -> Measured | None:
        """The error of a function where the budget holds it."""
        if made.function.body not in self._errors and not self.passes(made.function, budget):
            return None
        error = self.error(made)
        return error if error.fits(budget) else None

    def powers(self, exact: Specialised, budget: float, changes: list[Change]) -> int:
        """Whole exponents as multiplications, where there are any and the budget holds their error."""
        if not exact.whole:
            return 0
        made = self.specialised({}, LARGEST)
        if made.function.body == exact.function.body:
            return 0
        error = self.fits(made, budget)
        if error is None:
            return 0
        steps = [step for step in made.log if step.name == "powers"]
        what = "; ".join(dict.fromkeys(step.what for step in steps))
        why = "a constant whole exponent needs no logarithm"
        changes.append(Change("power", what, why, error.largest, brief="whole exponents as products"))
        return LARGEST

    def needed(self, choices: dict[Path, str], powers: int) -> dict[Path, str]:
        """The choices without those in terms that the exact passes removed."""
        paths = sorted(choices, reverse=True)
        idle = {path for path in paths if not self.search.differ(choices, _without(choices, path))}
        if not idle:
            return choices  # terms that change values are there
        whole = self.specialised(choices, powers).function.body
        fewest = {p: name for p, name in choices.items() if p not in idle}
        if self.specialised(fewest, powers).function.body == whole:
            return fewest
        for path in paths:
            fewer = _without(choices, path)
            if (
                not self.search.differ(choices, fewer)
                and self.specialised(fewer, powers).function.body == whole
            ):
                choices = fewer
        return choices

    def loosened(
        self, made: Specialised, prices: Prices, budget: float, changes: list[Change]
    ) -> Specialised:
        """Forms that lose digits near the hair, where these digits are not needed."""
        joined = loosened(made.function, SPLAT)
        if joined is not None:
            made = self.cleaned(joined)
        for bundle in BUNDLES:
            function, words = made.function, []
            for form in bundle:
                looser = self.looser(function, form)
                if looser is not None:
                    function = looser
                    words.append(form.words)
            if words:
                made = self.taken(made, function, "; ".join(words), prices, budget, changes)
        return made

    def looser(self, function: ir.Function, form: Form) -> ir.Function | None:
        """A function with a form wherever it applies; None where it does nowhere."""
        key = function.body, form.name
        if key not in self._looser:
            self._looser[key] = loosened(function, form)
        return self._looser[key]

    def taken(
        self,
        made: Specialised,
        function: ir.Function,
        what: str,
        prices: Prices,
        budget: float,
        changes: list[Change],
    ) -> Specialised:
        """A changed function where it is cheaper and the budget holds its error; else the one before."""
        if not self.passes(function, budget):
            return made
        candidate = self.cleaned(function)
        before, after = prices.body(made.function), prices.body(candidate.function)
        if after > (1.0 - SMALLEST_GAIN) * before:
            return made
        error = self.fits(candidate, budget)
        if error is None:
            return made
        changes.append(Change("form", what, _fewer(made, candidate), error.largest))
        return candidate

    def gathered(
        self, made: Specialised, prices: Prices, budget: float, changes: list[Change]
    ) -> Specialised:
        """Fewer multiplications by constants; twice, since what is cleaned may show more."""
        for _ in range(2):
            body = made.function.body
            if body not in self._gathered:
                self._gathered[body] = gathered(made.function)
            function = self._gathered[body]
            if function is not None:
                made = self.taken(made, function, "constant factors gathered", prices, budget, changes)
        return made

    def dropped(self, made: Specialised, prices: Prices, budget: float, changes: list[Change]) -> Specialised:
        """Numbers for terms that hardly vary."""
        for _ in range(MOST_DROPS):
            step = self.drop(made, prices, budget)
            if step is None:
                break
            made, change = step
            changes.append(change)
        return made

    def drop(self, made: Specialised, prices: Prices, budget: float) -> tuple[Specialised, Change] | None:
        price = prices.body(made.function)
        best: tuple[float, Specialised, Change] | None = None
        for term, replaced in self.without_terms(made.function, budget):
            if not self.passes(replaced, budget):
                continue
            candidate = self.cleaned(replaced)
            gain = price - prices.body(candidate.function)
            if gain <= SMALLEST_GAIN * price or (best is not None and gain <= best[0]):
                continue
            error = self.fits(candidate, budget)
            if error is None or self.witnesses(made, candidate) < WITNESSES:
                continue
            what = f"{_shown(made.function, term.expression)} -> {show(term.replacement)}"
            why = f"it stays within [{term.low:.3g}, {term.high:.3g}]; {_fewer(made, candidate)}"
            best = gain, candidate, Change("term", what, why, error.largest)
        return None if best is None else (best[1], best[2])

    def without_terms(self, function: ir.Function, budget: float) -> list[tuple[Term, ir.Function]]:
        """The terms of a function that a number may stand for, each with the function that has the number;
        those whose loss a glance shows to be too much are left out."""
        if function.body not in self._terms:
            few = self.search.screen
            given = {p.name: few.points.inputs[p.name] for p in function.parameters}
            found = terms(self.library, function, given)
            errors = errors_without(self.library, function, found, few)
            self._terms[function.body] = list(zip(found, errors, strict=True))
        left = [term for term, error in self._terms[function.body] if error.fits(budget)]
        holds = parts_of(function) if left else {}
        return [(term, without(function, term, holds)) for term in left]

    def witnesses(self, one: Specialised, other: Specialised) -> int:
        """How many points tell two functions apart."""
        first, second = (
            self.reference.values(self.library.with_functions([made.function]), made.function.name)
            for made in (one, other)
        )
        return int((first != second).any(axis=1).sum())

    def cleaned(self, function: ir.Function) -> Specialised:
        """A changed function run through the exact passes again."""
        if function.body not in self._cleaned:
            self._cleaned[function.body] = self._clean(function)
        return self._cleaned[function.body]

    def _clean(self, function: ir.Function) -> Specialised:
        library = self.library.with_functions([function])
        facts = self.knowledge.facts_of(function)
        return specialise(library, function.name, facts=facts, new_name=self.name, unroll=UNROLLED)


def _without(choices: dict[Path, str], path: Path) -> dict[Path, str]:
    return {p: name for p, name in choices.items() if p != path}


def _variants(found: Found, choices: dict[Path, str], prices: Prices) -> Sequence[Change]:
    return [
        Change(
            "variant",
            f"{s.new} for {s.old} in {s.caller}",
            "the cheapest whose domain covers the scene's ranges",
            s.together,
            _saving(s, prices),
            s.refused,
            s.new,
        )
        for s in found.steps
        if s.path in choices
    ]


def _saving(s: Substitution, prices: Prices) -> str:
    """What a variant saves by its price, and what one call takes in operations."""
    old, new = (
        sum(operations(prices.library.function(name), prices.library).values()) for name in (s.old, s.new)
    )
    return f"{s.saving:.3g} {prices.unit}, {prices.source}; {old} -> {new} operations"


def _fewer(before: Specialised, after: Specialised) -> str:
    old, new = sum(operations(before.function).values()), sum(operations(after.function).values())
    return f"{old} -> {new} operations"


def _shown(function: ir.Function, e: ir.Expr) -> str:
    for s in ir.statements(function.body):
        if isinstance(s, ir.Let) and s.value is e:
            return s.name
    return show(e)
