"""Docstrings: a summary, then one entry per parameter, `returns`, `degenerate`, `form`, `source`."""

from __future__ import annotations

import re

from codegen.ir.nodes import Doc

_ENTRY = re.compile(r"^([A-Za-z_][A-Za-z_0-9]*)  +(\S.*)$")


def parse(text: str) -> Doc:
    """The parsed docstring, as ast.get_docstring gives it; entries keep their order, lines are joined."""
    summary: list[str] = []
    entries: dict[str, str] = {}
    current: str | None = None
    for line in map(str.rstrip, text.splitlines()):
        if not line:
            continue
        found = _ENTRY.match(line)
        if found:
            current = found.group(1)
            entries[current] = found.group(2)
        elif current is not None and line.startswith(" "):
            entries[current] = f"{entries[current]} {line.strip()}"
        else:
            current = None
            summary.append(line.strip())
    return Doc(" ".join(summary), entries)
