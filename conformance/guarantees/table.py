"""shaderlib/guarantees.json: function -> table -> guarantee; writing, comparing, telling what is stale."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from codegen.guarantees import SPECIFICATIONS, SURVEYED, Guarantee, Surveyed, guarantees
from codegen.library import Library, default_root, load_library
from conformance.guarantees.survey import drawn_for, survey
from conformance.sources import CODE, hash_of

PATH = default_root() / SURVEYED
MADE_WITH = Path(__file__).with_name("made_with.txt")
"""A hash of what all figures were made with: another one, and every function is surveyed anew."""
MAKERS = ("codegen/intervals", "conformance/cases", "conformance/guarantees", "conformance/reference")
SHARE_TOLERANCE = 2e-3
"""Shares that differ by less count as equal: lanes near a threshold depend on float64's last bits."""
ERROR_TOLERANCE = 0.06
"""The same for errors, relative: two significant digits, rounded up."""

Found = Mapping[str, Surveyed]


def read() -> Found:
    """The guarantees on file."""
    return guarantees(load_library())


def surveyed(library: Library, names: Iterable[str]) -> dict[str, Surveyed]:
    """The guarantees of some functions under all tables."""
    found = {}
    for name in names:
        drawn = drawn_for(library, name)
        tables = {table: survey(library, name, table, drawn) for table in SPECIFICATIONS}
        found[name] = Surveyed(meaning(library, name), tables)
    return found


def meaning(library: Library, name: str) -> str:
    """A hash of what a function computes and of the bounds it is held to; words and places do not count."""
    digest = hashlib.sha256()
    for f in library.select([name]).functions:
        shown = (
            f"{f.name} {[(p.name, p.type.name, p.domain) for p in f.parameters]} {f.returns.name} {f.body}"
        )
        digest.update(re.sub(r"\bline=\d+", "", shown).encode())
    for b in library.bounds.get(name, ()):
        where = sorted(b.where.items())
        digest.update(f"{b.measure} {b.floor} {where} {b.field} {b.targets}".encode())
    return digest.hexdigest()[:12]


def made_with() -> str:
    """A hash of intervals, points and references as they are now."""
    return hash_of(MAKERS, (*CODE, ".csv"))


def stale(library: Library, found: Found) -> list[str]:
    """Public functions that the file lacks or knows in another form; all if they were made otherwise."""
    if MADE_WITH.read_text(encoding="ascii").strip() != made_with():
        return list(library.public)
    return [n for n in library.public if n not in found or found[n].of != meaning(library, n)]


def text(found: Found) -> str:
    """The file: one line for each function and table."""
    blocks = []
    for name, entry in found.items():
        rows = [f"      {json.dumps(t)}: {json.dumps(g.as_data())}" for t, g in entry.tables.items()]
        body = ",\n".join(rows)
        blocks.append(f'  {json.dumps(name)}: {{"of": "{entry.of}", "tables": {{\n{body}\n    }}}}')
    return "{\n" + ",\n".join(blocks) + "\n}\n"


def differences(old: Found, new: Found) -> list[str]:
    """What differs by more than the tolerances, one sentence each."""
    found = [f"{name}: no longer there" for name in old if name not in new]
    for name, entry in new.items():
        for table, g in entry.tables.items():
            before = old[name].tables.get(table) if name in old else None
            if before is None:
                found.append(f"{name} under {table}: not on file")
            else:
                found += [f"{name} under {table}: {what}" for what in _changes(before, g)]
    return found


def _changes(before: Guarantee, g: Guarantee) -> list[str]:
    found = []
    for what in ("uniform", "hard"):
        was, now = getattr(before, what), getattr(g, what)
        if abs(was - now) > SHARE_TOLERANCE:
            found.append(f"guaranteed share ({what}) {was} became {now}")
    same = len(before.errors) == len(g.errors) and all(
        _close(a, b) for a, b in zip(before.errors, g.errors, strict=True)
    )
    if not same:
        found.append(f"guaranteed errors {list(before.errors)} became {list(g.errors)}")
    return found


def _close(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return a == b or abs(a - b) <= ERROR_TOLERANCE * max(abs(a), abs(b))
