"""Line directives, so that a compiler itself names the source: `#line 24 3` in GLSL, by name in OpenCL C."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from codegen.emit import wrap
from codegen.emit.definition import Definition
from codegen.emit.dialect import Dialect
from codegen.errors import UserError

HOST = 0
"""Number of the string that the host compiles: what GLSL calls the text around ours."""


@dataclass(frozen=True)
class Directives:
    """How one file states source lines.

    numbers  source file -> its number from 1 on, where the target takes no names
    host     what the lines after the file belong to, as the target writes it
    """

    dialect: Dialect
    numbers: Mapping[str, int]
    host: str

    def at(self, path: str, line: int) -> str:
        """The directive that makes the next line `line` of a file."""
        file = path if self.by_name else str(self.numbers[path])
        return self.dialect.line_map.format(line=line, file=file)

    @property
    def by_name(self) -> bool:
        return '"' in self.dialect.line_map

    def back(self, line: int) -> str:
        """The directive that makes the next line `line` of the host."""
        return self.dialect.line_map.format(line=line, file=self.host if self.by_name else HOST)


def directives_of(dialect: Dialect, definitions: Sequence[Definition], host: str = "include") -> Directives:
    """The directives of a file; raises UserError for a target that has none.

    host  name that a C compiler gives to the lines after the file
    """
    if not dialect.line_map:
        raise UserError(f"{dialect.title} has no line directives; --map FILE.json says where lines come from")
    paths = dict.fromkeys(d.path for d in definitions if d.path)
    return Directives(dialect, {path: number for number, path in enumerate(paths, 1)}, host)


def with_directives(directives: Directives, head: Sequence[str], definitions: Sequence[Definition]) -> str:
    """The text of a file whose lines say where they come from.

    A directive stands wherever the next line would be counted wrongly, but for a closing brace alone. After
    each definition, outside of its guard, one more gives the host its own count back, as if the file began at
    the host's first line; a host that puts text before it states its own `#line` behind it.
    """
    lines = [*head, *_legend(directives), ""]
    for d in definitions:
        if directives.dialect.guard:
            lines += [f"#ifndef {d.guard}", f"#define {d.guard}"]
        lines += [*d.comment, *_traced(directives, d)]
        if directives.dialect.guard:
            lines.append("#endif")
        if d.path:
            lines.append(directives.back(len(lines) + 2))
        lines.append("")
    return "\n".join(lines[:-1]) + "\n"


def _traced(directives: Directives, d: Definition) -> Iterator[str]:
    expected = 0
    for text, line in zip(d.code, d.lines or (0,) * len(d.code), strict=True):
        if line and line != expected and text.strip() != "}":
            yield directives.at(d.path, line)
            expected = line
        yield text
        expected += 1


def _legend(directives: Directives) -> list[str]:
    """What the numbers of files mean, where there are no names."""
    if directives.by_name:
        return []
    told = ", ".join(f"{number} {path}" for path, number in directives.numbers.items())
    return ["//", *wrap.comment(f"Files by number in #line: {told}.", "// ", "//   ")]
