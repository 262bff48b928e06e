"""The comment above an emitted function: what it is, its domain, its declared error, its form and source."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from codegen.bounds import Bound
from codegen.emit import wrap
from codegen.emit.parameter import described
from codegen.ir import nodes as ir
from codegen.ir.types import Field

_WORD = re.compile(r"(?<![\w.])\w+")
_TAIL = ("returns", "degenerate", "error", "guaranteed", "form", "source")


def renamer(names: Iterable[str], prefix: str) -> Callable[[str], str]:
    """A function that puts the prefix before library names in running text (names of several words only)."""
    compound = {n for n in names if "_" in n or (n[:1].isupper() and n != n.upper())}
    return lambda text: _WORD.sub(lambda m: prefix + m[0] if m[0] in compound else m[0], text)


def function_comment(
    f: ir.Function, bounds: Iterable[Bound], target: str, rename: Callable[[str], str], guaranteed: str = ""
) -> list[str]:
    """The comment lines of one function.

    guaranteed  what the specification of this text promises of it; empty where that was not surveyed
    """
    entries = dict(f.doc.entries)
    for p in f.parameters:
        entries[p.name] = described(entries.get(p.name, ""), p.domain)
    errors = [b.describe() for b in bounds if not b.targets or target in b.targets]
    if errors:
        entries["error"] = "; ".join(errors)
    if guaranteed:
        entries["guaranteed"] = guaranteed
    order = [p.name for p in f.parameters] + [key for key in _TAIL if key in entries]
    note = {"variant": f"Variant of {f.base}.", "printed": f"As the lecture prints it; right: {f.base}."}
    summary = " ".join(filter(None, (f.doc.summary, note.get(f.kind, ""))))
    told = {key: rename(entries[key]) for key in order}
    return _comment(rename(summary), {**told, "from": f"{f.place.path}:{f.place.line}"})


def struct_comment(s: ir.StructDef, rename: Callable[[str], str]) -> list[str]:
    """The comment lines of one struct."""

    def entry(f: Field) -> str:
        return described(s.doc.entries.get(f.name, ""), f.domain)

    return _comment(rename(s.doc.summary), {f.name: rename(entry(f)) for f in s.type.fields})


def _comment(summary: str, entries: dict[str, str]) -> list[str]:
    width = max(map(len, entries))
    lines = wrap.comment(summary, "// ", "// ")
    for key, text in entries.items():
        lines += wrap.comment(text, f"//   {key.ljust(width)}  ", f"//   {' ' * width}  ")
    return lines
