"""Which part of its stated domain a function declares no bound for: python -m conformance.check.coverage.

Counted on the points of a check, without running anything: at random over the domain, and with the families
of hard cases, which crowd about the places that bounds leave out. uncovered.json keeps the shares, and
UNCOVERED.md shows them.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from codegen.bounds import Bound
from codegen.library import Library, load_library
from conformance.check.draws import draws, length
from conformance.check.features import applies

UNIFORM, FAMILY = 1000, 40
FOLDER = Path(__file__).parent
DATA, PAGE = FOLDER / "uncovered.json", FOLDER / "UNCOVERED.md"
DIGITS = 3


def uncovered(library: Library, name: str) -> tuple[float, float]:
    """Shares of the points outside every bound: of those at random, and of all with hard cases."""
    bounds = library.bounds.get(name, ())
    outside = {True: 0, False: 0}
    counted = {True: 0, False: 0}
    for drawn in draws(library.function(name), UNIFORM, FAMILY):
        count = length(drawn.inputs)
        inside = np.zeros(count, np.bool_)
        for bound in bounds:
            inside |= applies(bound, drawn.inputs, count)
        at_random = drawn.family == "uniform"
        outside[at_random] += int((~inside).sum())
        counted[at_random] += count
    random = outside[True] / max(counted[True], 1)
    return random, sum(outside.values()) / sum(counted.values())


def held(bound: Bound) -> str:
    """Where a bound holds, in terms of features."""
    return " and ".join(f"{text} in [{low:g}, {high:g}]" for text, (low, high) in bound.where.items())


def survey(library: Library) -> dict[str, dict[str, Any]]:
    """Function -> its shares and where its bounds hold, for functions that leave something out."""
    found = {}
    for name in library.public:
        at_random, everywhere = uncovered(library, name)
        if everywhere > 0.0:
            where = list(dict.fromkeys(held(b) for b in library.bounds[name]))
            found[name] = {
                "random": round(at_random, DIGITS),
                "all": round(everywhere, DIGITS),
                "held": where,
            }
    return found


def page(found: dict[str, dict[str, Any]]) -> str:
    """The table of UNCOVERED.md."""
    lines = [
        "# Where no error bound is declared",
        "",
        "Written by `python -m conformance.check.coverage`. Every other public function declares bounds for "
        "its whole stated domain. Of these here, the shares left out are those of "
        f"{UNIFORM} points at random, and of these with {FAMILY} points of each family of hard cases. What "
        "they return there must be finite and is judged by the specification's interval all the same; only "
        "its error is no promise.",
        "",
        "| function | at random | with hard cases | bounds hold for |",
        "|---|--:|--:|---|",
    ]
    for name, row in sorted(found.items(), key=lambda item: -item[1]["random"]):
        lines.append(f"| {name} | {row['random']:.1%} | {row['all']:.1%} | {'; or '.join(row['held'])} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Survey every function anew."""
    library = load_library()
    found = survey(library)
    DATA.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    PAGE.write_text(page(found), encoding="utf-8")


if __name__ == "__main__":
    main()
