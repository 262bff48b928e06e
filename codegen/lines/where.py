"""From a compiler's message back to the source: which lines a log names, and where these come from."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from codegen.lines.linemap import LineMap, Origin

_PLACES = (
    re.compile(r"^(?:ERROR|WARNING): (?P<file>\d+):(?P<line>\d+):"),  # glslangValidator, ANGLE
    re.compile(r"^\s*(?P<file>\d+):(?P<line>\d+)\(\d+\): (?:error|warning)"),  # Mesa
    re.compile(r"^\s*(?P<file>\d+)\((?P<line>\d+)\) : (?:error|warning)"),  # NVIDIA's OpenGL
    re.compile(r"┌─ .*?(?P<line>\d+):\d+$"),  # naga
    re.compile(r"^:(?P<line>\d+):\d+ (?:error|warning)"),  # Tint
    re.compile(r"^(?:error|warning): (?P<name>[^:]+):(?P<line>\d+):\d+: "),  # PoCL
    re.compile(r"^(?P<name>[^\s:][^:]*):(?P<line>\d+):\d+: (?:fatal )?(?:error|warning)"),  # Clang
)
"""How compilers name a place."""


@dataclass(frozen=True)
class Message:
    """A line of a log that names a place.

    file  number of the source string that it names; 0 where it names none or the first
    line  the line that it names
    name  the file that it names, where it does so by name
    """

    text: str
    file: int
    line: int
    name: str = ""


def messages(log: str) -> Iterator[Message | str]:
    """The lines of a log: those that name a place as messages, the others as they are."""
    for text in log.splitlines():
        found = next((m for m in (place.search(text) for place in _PLACES) if m), None)
        if found is None:
            yield text
            continue
        parts = found.groupdict()
        yield Message(text, int(parts.get("file") or 0), int(parts["line"]), parts.get("name") or "")


def origin_of(found: LineMap, message: Message, first: int = 1) -> Origin | None:
    """Where what a message names comes from; None for a line that is not ours.

    first  the line of the host's text in which the emitted file begins
    """
    if message.name and any(o.file == message.name for o in found.origins.values()):
        near = [o for o in found.origins.values() if o.file == message.name and o.line <= message.line]
        function = max(near, key=lambda o: o.line).function if near else ""
        return Origin(function, message.name, message.line)
    if message.file in found.files:
        return found.in_file(message.file, message.line)
    return found.origins.get(message.line - first + 1)


def annotated(found: LineMap, log: str, first: int = 1) -> Iterator[str]:
    """The log with, below each line that names a line of ours, where that comes from."""
    for part in messages(log):
        if isinstance(part, str):
            yield part
            continue
        yield part.text
        origin = origin_of(found, part, first)
        if origin is not None:
            yield f"    from {origin}"
