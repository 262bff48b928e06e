"""The page of guarantees beside declared bounds, generated from shaderlib/guarantees.json."""

from __future__ import annotations

from collections.abc import Mapping

from codegen.bounds import Bound
from codegen.guarantees import SPECIFICATIONS, Guarantee, Surveyed, error, exempt, guarantees
from codegen.ir.domains import number
from codegen.library import Library

SHOWN = tuple(SPECIFICATIONS)
_HEAD = """\
# What is declared, and what specifications guarantee
Generated from `guarantees.json`, which `python -m conformance.guarantees` writes; do not edit.

Two different promises stand side by side for every function:

- **declared**: an error that no driver exceeded on any input tried, with a margin. The origin of each number
  is in the `bounds.toml` of its section; every run of `vair check` holds the drivers at hand to it.
- **guaranteed**: the largest error of any result that the specification permits, whatever a driver makes of
  it: every operation at the worst of its promised accuracy, rounded either way, flushed or not, fused or not.
  By interval evaluation on 4000 random points of the domain and on up to 250 of each family of hard cases; a
  share of 100 % means that every one of them is bounded, and the error is the largest of them.

A driver is usually far better than its specification, so a declared bound may be the smaller one: {smaller}
of {judged} under WGSL. It then says what to expect, not what is owed.
"""


def page(library: Library) -> str:
    """The page; without surveyed guarantees its head alone."""
    found = guarantees(library)
    judged = [pair for name in library.public for pair in _pairs(library, found, name)]
    smaller = sum(e > _limit(b) for b, e in judged)
    lines = [_HEAD.format(smaller=smaller, judged=len(judged)), *_summary(library, found), ""]
    for section in dict.fromkeys(f.module for f in library.public.values()):
        lines += [f"## {section}", "", *_table(library, found, section), ""]
    return "\n".join(lines).rstrip("\n") + "\n"


def _pairs(library: Library, found: Mapping[str, Surveyed], name: str) -> list[tuple[Bound, float]]:
    if name not in found:
        return []
    errors = found[name].tables["wgsl"].errors
    return [(b, e) for b, e in zip(library.bounds_of(name), errors, strict=False) if e is not None]


def _limit(bound: Bound) -> float:
    return 0.0 if bound.measure == "exact" else bound.bound


def _summary(library: Library, found: Mapping[str, Surveyed]) -> list[str]:
    lines = ["| specification | functions guaranteed on their whole domain |", "|---|---|"]
    names = [name for name in library.public if name in found]
    for table, title in SPECIFICATIONS.items():
        whole = sum(found[name].tables[table].everywhere for name in names)
        lines.append(f"| {title} | {whole} of {len(names)} |")
    lines.append("")
    for entry in exempt(library):
        who = "functions" if entry.function == "*" else f"`{entry.function}`"
        title = SPECIFICATIONS.get(entry.table, "every table")
        lines.append(f"Not guaranteed, {who} under {title}: {entry.reason}. Closing it: {entry.cost}.")
    return lines


def _table(library: Library, found: Mapping[str, Surveyed], section: str) -> list[str]:
    titles = " | ".join(SPECIFICATIONS[table] for table in SHOWN)
    lines = [f"| function | declared | {titles} |", f"|---|---|{'---:|' * len(SHOWN)}"]
    for name, f in library.public.items():
        if f.module != section or name not in found:
            continue
        tables = found[name].tables
        bounds = library.bounds_of(name)
        shares = {table: _share(tables[table]) for table in SHOWN}
        for k, bound in enumerate(bounds):
            cells = [f"{_error(bound, tables[t], k)}{shares[t] if k == 0 else ''}" for t in SHOWN]
            title = f"`{name}`" if k == 0 else ""
            lines.append(f"| {title} | {_declared(bound)} | {' | '.join(cells)} |")
    return lines


def _declared(bound: Bound) -> str:
    return bound.describe().replace("|", "\\|")


def _error(bound: Bound, found: Guarantee, k: int) -> str:
    value = found.errors[k] if k < len(found.errors) else None
    if value is None:
        return "-"
    return error(bound, value, "")


def _share(found: Guarantee) -> str:
    return (
        "" if found.everywhere else f" ({number(100 * found.uniform)} %; hard {number(100 * found.hard)} %)"
    )
