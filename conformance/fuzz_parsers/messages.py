"""What `vair where` reads: line maps, and logs of compilers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from codegen.documents import read_text
from codegen.lines.linemap import COLUMNS, LineMap, Origin, read_map
from codegen.lines.where import Message, annotated, origin_of
from codegen.version import VERSION
from conformance.fuzz_parsers.parser import Parser, json_parser

LOG = """\
ERROR: 0:3: 'x' : undeclared identifier
WARNING: 2:22: 'y' : unused
0:4(12): error: no such name
0(5) : error C0000: syntax error
   \u250c\u2500 wgsl:6:9
:2:11 error: unresolved value
error: core/angles.py:21:3: use of undeclared identifier
angles.py:3:14: fatal error: expected ';'
ERROR: 2 compilation errors.  No code generated.
"""


def line_map() -> Parser:
    """The map of `vair emit --map`, asked for a log and for each of its lines."""

    def read(path: Path) -> object:
        found = read_map(path)
        return [*annotated(found, LOG), *(origin_of(found, Message("", 0, line), 3) for line in range(1, 9))]

    head = {"format": 1, "version": VERSION, "target": "glsl", "dialect": "430", "lines": 6}
    rows = [
        [3, "vair_f", "core/angles.py", 20],
        [4, "vair_f", "core/angles.py", 21],
        [5, "vair_g", "a.py", 1],
    ]
    files = {"1": "core/angles.py", "2": "a.py"}
    trees = [
        head | {"files": given, "columns": list(COLUMNS), "map": rows} for given in (dict[str, str](), files)
    ]
    return json_parser("map.json", read, trees)


def compiler_log() -> Parser:
    """What a compiler said, held against a map."""
    origins = {line: Origin("vair_f", "core/angles.py", line + 17) for line in range(1, 40)}
    found = LineMap("glsl", "430", 60, origins, {1: "core/angles.py"})
    read: Callable[[Path], object] = lambda path: list(annotated(found, read_text(path), 2))  # noqa: E731
    return Parser("own.log", read, (LOG.encode(),))
