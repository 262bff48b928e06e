"""A line map: emitted line -> function, source file, source line; as JSON beside an emitted file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codegen.documents import read_json
from codegen.emit.definition import Definition
from codegen.emit.dialect import Dialect
from codegen.errors import UserError
from codegen.version import VERSION

FORMAT = 1
COLUMNS = ("line", "function", "file", "source_line")


@dataclass(frozen=True)
class Origin:
    """What an emitted line says: the emitted name that it defines, and the source line."""

    function: str
    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line} ({self.function})"


@dataclass(frozen=True)
class LineMap:
    """The lines of one file.

    lines    number of lines of the file
    origins  line, from 1 on -> its origin; comments, guards and the header have none
    files    number in a #line directive -> source file; empty without such directives
    """

    target: str
    dialect: str
    lines: int
    origins: Mapping[int, Origin]
    files: Mapping[int, str]

    def in_file(self, number: int, line: int) -> Origin | None:
        """The origin that a compiler means which has followed the directives: file number and its line."""
        path = self.files.get(number)
        if path is None:
            return None
        near = [o for o in self.origins.values() if o.file == path and o.line <= line]
        return (
            Origin(max(near, key=lambda o: o.line).function, path, line) if near else Origin("", path, line)
        )


def map_of(
    dialect: Dialect, text: str, definitions: Sequence[Definition], files: Mapping[str, int] | None = None
) -> LineMap:
    """The map of a file's text, with directives or without.

    files  source file -> its number in directives, see codegen.lines.directives
    """
    origins: dict[int, Origin] = {}
    lines = text.splitlines()
    position = 0
    for d in definitions:
        paths = d.paths or (d.path,) * len(d.code)
        for code, line, path in zip(d.code, d.lines or (0,) * len(d.code), paths, strict=True):
            while lines[position] != code:
                position += 1
            position += 1
            if line:
                origins[position] = Origin(d.name, path, line)
    numbers = {number: path for path, number in (files or {}).items()}
    return LineMap(dialect.target, dialect.name, len(lines), origins, numbers)


def as_json(found: LineMap) -> str:
    """The file of a map; one line for each line that has an origin."""
    head = {
        "format": FORMAT,
        "version": VERSION,
        "target": found.target,
        "dialect": found.dialect,
        "lines": found.lines,
        "files": {str(number): path for number, path in found.files.items()},
        "columns": COLUMNS,
    }
    rows = ",\n".join(json.dumps([line, o.function, o.file, o.line]) for line, o in found.origins.items())
    return f'{json.dumps(head)[:-1]},\n"map": [\n{rows}\n]}}\n'


def read_map(path: Path) -> LineMap:
    """A map that `vair emit --map` wrote; raises UserError for anything else."""
    data = read_json(path)
    if not isinstance(data, dict) or "map" not in data:
        raise UserError(f"{path}: is no line map; --map of vair emit, vendor and scene writes one")
    if data.get("format") != FORMAT:
        raise UserError(f"{path}: has format {data.get('format')}; this is vair {VERSION}, format {FORMAT}")
    try:
        origins = {_number(row[0]): Origin(str(row[1]), str(row[2]), _number(row[3])) for row in data["map"]}
        files = {int(number): str(path) for number, path in data["files"].items()}
        return LineMap(
            str(data["target"]),
            str(data["dialect"]),
            _number(data["lines"]),
            dict(sorted(origins.items())),
            files,
        )
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        raise UserError(f"{path}: is damaged: a row is {', '.join(COLUMNS)}") from None


def _number(value: Any) -> int:
    if type(value) is not int or value < 1:
        raise ValueError("line numbers count from 1 on")
    return value
