"""What is changed in an accuracy table: numbers, kinds, ranges, formulas and settings; never the sentences.

Tables are changed as text, line by line, since that is what is read: a row of a table is a few lines.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from conformance.mutation.sites import Mutant

KINDS = {
    "exact": ("rounded", "unstated"),
    "rounded": ("exact", "unstated"),
    "ulp": ("rounded", "unstated"),
    "absolute": ("unstated",),
    "inherited": ("rounded", "unstated"),
    "scaled": ("exact", "unstated"),
    "filter": ("unstated",),
}
"""What another kind a row may be said to have: a tighter one, and no promise at all."""
FORMULAS = {
    "x / length(x)": "x inverse_sqrt(dot(x, x))",
    "x inverse_sqrt(dot(x, x))": "x / length(x)",
    "x / length(x) or x inverse_sqrt(dot(x, x))": "x / length(x)",
}
"""The formulas that another one could stand for."""
OPTIONAL = (
    "magnitude",
    "zero",
    "normal",
    "reciprocal",
    "whole",
    "per_abs_x",
    "per_component",
    "elsewhere_ulps",
)
"""Keys that a row can do without."""
_NUMBER = re.compile(r"-?\d+(\.\d+)?(e[+-]?\d+)?")
_LINE = re.compile(r"(?P<key>\w+) = (?P<value>.+)")

Change = tuple[int, str, str, str, str]
"""Number of the line, row, operator, before, after; a line that becomes empty is dropped."""


def _values(key: str, value: str) -> Iterator[tuple[str, str]]:
    match key, value:
        case "kind", _:
            for other in KINDS.get(value.strip('"'), ()):
                yield "kind", f'"{other}"'
        case "formula", _:
            if value.strip('"') in FORMULAS:
                yield "formula", f'"{FORMULAS[value.strip(chr(34))]}"'
        case "rounding", _:
            yield "setting", '"nearest"' if value == '"either"' else '"either"'
        case _, "true" | "false":
            yield "setting", "false" if value == "true" else "true"
        case _ if not value.startswith('"'):
            for found in _NUMBER.finditer(value):
                for operator, factor in (("halved", 0.5), ("doubled", 2.0)):
                    yield operator, value[: found.start()] + _times(found[0], factor) + value[found.end() :]


def _times(text: str, factor: float) -> str:
    """A whole number stays one where it can."""
    number = float(text) * factor
    return str(int(number)) if number == int(number) and "." not in text else repr(number)


def _changes(text: str) -> Iterator[Change]:
    row, settings = "", False
    for number, line in enumerate(text.splitlines()):
        if line.startswith("["):
            row, settings = line.strip("[]").removeprefix("operations."), line == "[settings]"
        found = _LINE.fullmatch(line)
        if found is None or settings:
            continue
        for operator, value in _values(found["key"], found["value"]):
            yield number, row, operator, line, f"{found['key']} = {value}"
        if found["key"] in OPTIONAL:
            yield number, row, "dropped", line, ""


def _text(text: str, change: Change) -> str:
    lines = text.splitlines()
    number, _, operator, _, after = change
    if operator == "kind":
        return "\n".join(_with_kind(lines, number, after)) + "\n"
    lines[number : number + 1] = [after] if after else []
    return "\n".join(lines) + "\n"


def _with_kind(lines: list[str], number: int, after: str) -> list[str]:
    """Another kind takes none of the old one's keys."""
    end = next((k for k in range(number, len(lines)) if lines[k].startswith("[")), len(lines))
    kept = [line for line in lines[number + 1 : end] if not line or line.startswith(("cite", "assumed", "#"))]
    return [*lines[:number], after, *kept, *lines[end:]]


def mutants(path: str, text: str) -> list[Mutant]:
    """Every mutant of a table."""
    return [
        Mutant(path, row, operator, before, after or "nothing", index, number + 1)
        for index, (number, row, operator, before, after) in enumerate(_changes(text))
    ]


def mutated(text: str, index: int) -> str:
    """The text of a table with its mutant of that number."""
    return _text(text, list(_changes(text))[index])
