"""Docstrings: a summary, then one entry per parameter, `returns`, `degenerate`, `form`, `source`."""

from __future__ import annotations

import re

from codegen.ir.nodes import Doc

_ENTRY = re.compile(r"^([A-Za-z_][A-Za-z_0-9]*)(?:  +|\t)(\S.*)$")


def parse(text: str | None) -> Doc:
    """The parsed docstring; entries keep their order, continuation lines are joined."""
    if not text:
        return Doc("", {})
    lines = [line.rstrip() for line in _dedent(text)]
    summary: list[str] = []
    entries: dict[str, str] = {}
    current: str | None = None
    for line in lines:
        found = _ENTRY.match(line)
        if found:
            current = found.group(1)
            entries[current] = found.group(2)
        elif not line:
            continue
        elif current is not None and line.startswith(" "):
            entries[current] = f"{entries[current]} {line.strip()}"
        else:
            current = None
            summary.append(line.strip())
    return Doc(" ".join(summary), entries)


def _dedent(text: str) -> list[str]:
    first, *rest = text.expandtabs().splitlines()
    margin = min((len(r) - len(r.lstrip()) for r in rest if r.strip()), default=0)
    return [first.strip(), *(r[margin:] for r in rest)]
