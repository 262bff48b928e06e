"""The cheapest variant within an error, from recorded measurements: `vair emit --max-error`.

Only what is recorded decides, so that the same files give the same choice everywhere. An error is that over
the whole domain of the base, as far as that declares an error itself: what is declared everywhere, else the
largest found. Of several recorded drivers of a target the largest error counts, and the geometric mean of the
times.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codegen.costs import entry, recorded
from codegen.errors import UserError
from codegen.ir.domains import number
from codegen.library import Library

MEASURES = ("absolute", "relative", "ulp")
MODE = "throughput"
RESOLVED = 0.01
"""Net times below this share of the whole time count as this share."""


@dataclass(frozen=True)
class Candidate:
    """A base or a variant with what is recorded of it.

    ns        driver -> nanoseconds per evaluation
    error     over the base's whole domain; infinite where it does not hold there
    source    declared or measured; else why it cannot stand for the base
    current   whether its source is still what was measured
    """

    name: str
    ns: Mapping[str, float]
    error: float
    source: str
    current: bool

    @property
    def cost(self) -> float:
        """What candidates are ordered by: the geometric mean over the drivers."""
        return math.exp(sum(math.log(ns) for ns in self.ns.values()) / len(self.ns))


@dataclass(frozen=True)
class Choice:
    """What was chosen for one function, and what from.

    candidates  cheapest first; empty where the function has no variants
    note        what a user should know beside
    """

    function: str
    chosen: str
    candidates: tuple[Candidate, ...] = ()
    note: str = ""


def choose_all(
    library: Library,
    target: str,
    names: Sequence[str] | None,
    limit: float,
    measure: str,
    folder: Path | None = None,
) -> list[Choice]:
    """A choice for each of these functions; for all public ones if None.

    raises  UserError where nothing is recorded of the target or of a named function, or where no variant of a
            named function is within the limit
    """
    results = [r for r in recorded(folder) if r["device"]["target"] == target]
    if not results:
        raise UserError(
            f"nothing is recorded for {target}, so no variant can be chosen; vair report --record measures"
        )
    if names is not None:
        unique = dict.fromkeys(base_of(library, name) for name in names)
        return [choose(library, results, base, limit, measure) for base in unique]
    found = []
    for name in [f.name for f in library.public.values() if f.kind == "base"]:
        try:
            choice = choose(library, results, name, limit, measure)
            found.append(choice if choice.candidates else Choice(name, name))
        except UserError as e:
            found.append(Choice(name, name, note=f"{e}; the default stays"))
    return found


def base_of(library: Library, name: str) -> str:
    """The function that a name stands for: a variant stands for its base."""
    f = library.function(name)
    return f.name if f.base is None else base_of(library, f.base)


def choose(
    library: Library, results: Sequence[dict[str, Any]], base: str, limit: float, measure: str
) -> Choice:
    """The cheapest candidate of a base within the limit; raises UserError where there is none."""
    if not any(f.kind == "variant" for f in library.variants(base)):
        return Choice(base, base, note=f"{base} has no variants to choose from")
    found = candidates(library, results, base, measure)
    target = results[0]["device"]["target"]
    if not found:
        raise UserError(
            f"nothing is recorded of {base} for {target}; vair report --record measures what is missing"
        )
    fitting = [c for c in found if c.error <= limit]
    if not fitting:
        best = min(found, key=lambda c: (c.error, c.cost))
        reached = f"the best is {best.name} with {number(best.error)}" if math.isfinite(best.error) else ""
        raise UserError(
            f"no variant of {base} stays within {measure} {number(limit)} on its whole domain for {target}; "
            f"{reached or 'none has a bounded error there'}"
        )
    old = [c.name for c in found if not c.current]
    note = f"measured of older sources: {', '.join(old)}" if old else ""
    return Choice(base, fitting[0].name, tuple(found), note)


def candidates(
    library: Library, results: Sequence[dict[str, Any]], base: str, measure: str
) -> list[Candidate]:
    """The base and its variants that every result knows, cheapest first."""
    found = []
    for name in (base, *_variants(library, base)):
        entries = {r["device"]["short"]: entry(r, name) for r in results}
        told = {driver: e for driver, e in entries.items() if e is not None and e["whole"] is not None}
        if len(told) < len(results):
            continue
        judged = [_error(e["whole"], measure) for e in told.values()]
        error, source = max(judged, key=lambda pair: pair[0])
        digest = library.select([name]).source_hash
        found.append(
            Candidate(
                name,
                {driver: _ns(e["speed"][MODE]) for driver, e in told.items()},
                error,
                source,
                all(e["source_hash"] == digest for e in told.values()),
            )
        )
    return sorted(found, key=lambda c: (c.cost, c.name))


def _variants(library: Library, base: str) -> list[str]:
    direct = [f.name for f in library.variants(base) if f.kind == "variant"]
    return [name for f in direct for name in (f, *_variants(library, f))]


def _ns(speed: Mapping[str, Any]) -> float:
    return max(float(speed["net_ns"]), RESOLVED * float(speed["gross_ns"]))


def _error(whole: Mapping[str, Any], measure: str) -> tuple[float, str]:
    """The error in a measure and where it is known from."""
    if whole["narrower"]:
        return math.inf, f"accepts only {', '.join(whole['narrower'])}"
    if whole["non_finite"]:
        return math.inf, f"{whole['non_finite']} results were not finite"
    declared = whole["declared"].get(measure)
    if declared is not None:
        return float(declared), "declared"
    largest = whole["largest"].get(measure)
    return (math.inf, "unbounded") if largest is None else (float(largest), "measured")


def front(found: Sequence[Candidate]) -> list[Candidate]:
    """The candidates that no cheaper one matches in error; cheapest first, as they come."""
    kept: list[Candidate] = []
    for c in found:
        if math.isfinite(c.error) and all(c.error < k.error for k in kept):
            kept.append(c)
    return kept


def describe(choice: Choice, target: str, limit: float, measure: str) -> list[str]:
    """Lines for people: the front that was chosen from, dearest last, and what is not on it."""
    if not choice.candidates:
        return [choice.note] if choice.note else []
    drivers = ", ".join(choice.candidates[0].ns)
    lines = [
        f"{choice.function}: {measure} error <= {number(limit)} on its whole domain, {target} ({drivers})"
    ]
    on_front = front(choice.candidates)
    for c in choice.candidates:
        times = ", ".join(f"{ns:.3g}" for ns in c.ns.values())
        error = f"{c.error:.2g} {c.source}" if math.isfinite(c.error) else c.source
        mark = ">" if c.name == choice.chosen else " "
        beaten = "" if c in on_front else ", not on the front"
        lines.append(f"  {mark} {c.name}: {times} ns, {error}{beaten}")
    return [*lines, *([f"    note: {choice.note}"] if choice.note else [])]
