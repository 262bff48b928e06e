"""For which part of its domain a function declares no telling bound: python -m conformance.check.coverage.

Counted on the points of a check, without running anything: at random over the domain, and with the families
of hard cases, which crowd about the places that sharp bounds leave out. A part is left out, or it has the
range of the results for its only bound, which says no more than that the function returns what it may return.
uncovered.json keeps the shares, and UNCOVERED.md shows them.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from codegen.library import Library, load_library
from conformance.check.draws import draws, length
from conformance.check.features import applies

UNIFORM, FAMILY = 1000, 40
FOLDER = Path(__file__).parent
DATA, PAGE = FOLDER / "uncovered.json", FOLDER / "UNCOVERED.md"
DIGITS = 3
RANGE = "range of the results"
"""How the origin of a bound begins that is as wide as the results."""

REASONS = {
    "strand_pdf": "towards the axis, for exponents below 2, the density has a pole that float32 misses",
    "poulin_fournier_value*": "its highlights are not measured at heights between 0 and 1e-12",
}
"""Functions that leave something out, and why."""


@dataclass(frozen=True)
class Shares:
    """Shares of the points outside the bounds that are counted: of those at random, and of all."""

    random: float
    all: float


def uncovered(library: Library, name: str) -> Shares:
    """What lies outside every bound of a function."""
    return shares(library, name)[0]


def shares(library: Library, name: str) -> tuple[Shares, Shares]:
    """What lies outside every bound, and what lies outside every bound that tells more than the range."""
    bounds = library.bounds.get(name, ())
    telling, ranges = [b for b in bounds if not is_range(b)], [b for b in bounds if is_range(b)]
    counted, outside = np.zeros(2), np.zeros((2, 2))
    for drawn in draws(library.function(name), UNIFORM, FAMILY):
        count = length(drawn.inputs)
        kind = 0 if drawn.family == "uniform" else 1
        counted[kind] += count
        told = _inside(telling, drawn.inputs, count)
        outside[0, kind] += int((~(told | _inside(ranges, drawn.inputs, count))).sum())
        outside[1, kind] += int((~told).sum())
    left_out, ranged = (
        Shares(float(o[0] / max(counted[0], 1)), float(o.sum() / counted.sum())) for o in outside
    )
    return left_out, ranged


def _inside(bounds: list[Bound], inputs: dict[str, Any], count: int) -> npt.NDArray[np.bool_]:
    inside = np.zeros(count, np.bool_)
    for bound in bounds:
        inside |= applies(bound, inputs, count)
    return inside


def is_range(bound: Bound) -> bool:
    """Whether a bound says only that results are where they may be."""
    return bound.origin.startswith(RANGE)


def held(bound: Bound) -> str:
    """Where a bound holds, in terms of features."""
    return " and ".join(f"{text} in [{low:g}, {high:g}]" for text, (low, high) in bound.where.items())


def survey(library: Library) -> dict[str, dict[str, Any]]:
    """Function -> its shares and where its telling bounds hold, for functions that have gaps in these."""
    found = {}
    for name in library.public:
        left_out, ranged = shares(library, name)
        if ranged.all > 0.0:
            telling = [held(b) for b in library.bounds[name] if not is_range(b)]
            found[name] = {
                "left out": [round(left_out.random, DIGITS), round(left_out.all, DIGITS)],
                "range only": [round(ranged.random, DIGITS), round(ranged.all, DIGITS)],
                "told": list(dict.fromkeys(telling)),
            }
    return found


def page(found: dict[str, dict[str, Any]]) -> str:
    """UNCOVERED.md: what is left out, with its reason, and what has only the range of the results."""
    left_out = {name: row for name, row in found.items() if any(row["left out"])}
    ranged = {name: row for name, row in found.items() if name not in left_out}
    lines = [
        "# Where error bounds are missing or say little",
        "",
        "Written by `python -m conformance.check.coverage`. Shares are those of "
        f"{UNIFORM} points at random over the stated domain, and of these with {FAMILY} points of each "
        "family of hard cases. What functions return everywhere must be finite and is judged by the "
        "specification's interval all the same.",
        "",
        "## Left out",
        "",
        "Parts for which no bound is declared, and why.",
        "",
        "| function | at random | with hard cases | why |",
        "|---|--:|--:|---|",
        *(_row(name, row["left out"], _reason(name)) for name, row in _sorted(left_out, "left out")),
        "",
        "## No more than the range of the results",
        "",
        "Parts in which a function may be as far off as its results reach: directions along which a sum or a "
        "product cancels, jumps that rounding moves, exponents below those that a variant is made for. The "
        "last column says where the error is bounded by less.",
        "",
        "| function | at random | with hard cases | less than the range |",
        "|---|--:|--:|---|",
        *(
            _row(name, row["range only"], "; or ".join(row["told"]) or "nowhere")
            for name, row in _sorted(ranged, "range only")
        ),
    ]
    return "\n".join(lines) + "\n"


def _sorted(rows: dict[str, dict[str, Any]], key: str) -> list[tuple[str, dict[str, Any]]]:
    return sorted(rows.items(), key=lambda item: -item[1][key][0])


def _row(name: str, of: list[float], text: str) -> str:
    return f"| {name} | {of[0]:.1%} | {of[1]:.1%} | {text} |"


def _reason(name: str) -> str:
    return next((why for glob, why in REASONS.items() if fnmatchcase(name, glob)), "no reason is given")


def main() -> None:
    """Survey every function anew."""
    library = load_library()
    found = survey(library)
    DATA.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    PAGE.write_text(page(found), encoding="utf-8")


if __name__ == "__main__":
    main()
