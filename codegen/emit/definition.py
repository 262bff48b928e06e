"""One definition of an emitted file, and the guard that lets several files define it.

A guard is named after the definition and its code: `VAIR_SIN_ANGLE_5D2F09AB`. So any files with one prefix
stand in one shader, in any order, and what they share is defined once. Where two of them define a name
differently, as files of two versions do, both definitions reach the compiler, which says so: no version wins
silently. WGSL has no preprocessor: there one module takes one file of a prefix.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

from codegen.emit.dialect import Dialect

DIGITS = 8
_WORD = re.compile(r"\w+")
_NAME = re.compile(r"\bstruct\s+(\w+)|(\w+)\s*\(")


@dataclass(frozen=True)
class Definition:
    """A struct or a function as text.

    name     as it is emitted, with its prefix
    comment  lines above it
    code     lines of the definition
    source   the function of the library that it is a form of; empty for structs and lookups
    path     the source file that it says; empty where none is known
    lines    the line of that file which each line of code says; 0 where none is known
    paths    the source file of each line, where a function was made of several; else empty
    """

    name: str
    comment: tuple[str, ...]
    code: tuple[str, ...]
    path: str = field(default="", compare=False)
    lines: tuple[int, ...] = field(default=(), compare=False)
    paths: tuple[str, ...] = field(default=(), compare=False)
    source: str = field(default="", compare=False)

    @cached_property
    def words(self) -> frozenset[str]:
        """The words of its code, comments left out."""
        return frozenset(word for line in self.code for word in _WORD.findall(line.partition("//")[0]))

    @property
    def guard(self) -> str:
        """The macro of its guard; the same for the same code, whatever the comment says."""
        digest = hashlib.sha256("\n".join(self.code).encode()).hexdigest()[:DIGITS]
        return f"{self.name}_{digest}".upper()


def reached(name: str, definitions: Iterable[Definition]) -> list[Definition]:
    """A definition and all that its code needs, in their order; empty where it is not among them."""
    listed = list(definitions)
    by_name = {d.name: d for d in listed}
    needed, pending = {name}, [name] if name in by_name else []
    while pending:
        found = by_name[pending.pop()].words & by_name.keys() - needed
        needed |= found
        pending += found
    return [d for d in listed if d.name in needed]


def plain(definitions: Iterable[Definition]) -> list[str]:
    """The lines of definitions, an empty one between them."""
    lines: list[str] = []
    for d in definitions:
        lines += [*d.comment, *d.code, ""]
    return lines[:-1]


def guarded(definitions: Iterable[Definition], dialect: Dialect) -> list[str]:
    """The same, each definition in its guard, where the dialect has a preprocessor."""
    if not dialect.guard:
        return plain(definitions)
    lines: list[str] = []
    for d in definitions:
        lines += [f"#ifndef {d.guard}", f"#define {d.guard}", *d.comment, *d.code, "#endif", ""]
    return lines[:-1]


def read_definitions(text: str) -> list[Definition]:
    """The definitions of an emitted text; what is none of them, as a header, is left out.

    A definition starts where a line does and ends with the first line that starts with a closing brace; the
    comment right above belongs to it. Text that a person laid out otherwise gives other definitions, or none.
    """
    found: list[Definition] = []
    comment: list[str] = []
    code: list[str] = []
    for line in text.splitlines():
        if not code and line.endswith(";"):  # a directive such as enable f16;
            comment = []
        elif code or (line.strip() and not line.startswith(("//", "#"))):
            code.append(line)
            name = _NAME.search(code[0])
            if line.startswith("}") and name is not None:
                found.append(Definition(name[1] or name[2], tuple(comment), tuple(code)))
            if line.startswith("}"):
                comment, code = [], []
        elif line.startswith("//"):
            comment.append(line)
        else:
            comment = []
    return found
