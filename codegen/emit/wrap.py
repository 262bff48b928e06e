"""Breaking long lines: at commas and operators of the shallowest depth, continuation lines indented."""

from __future__ import annotations

import re
import textwrap

WIDTH = 100


def code(line: str, indent: str, hang: str | None = None) -> list[str]:
    """The statement as lines of at most WIDTH columns where it can be broken at all.

    hang  what further lines start with; a step more than the first if None
    """
    hang = indent + "    " if hang is None else hang
    if len(indent) + len(line) <= WIDTH:
        return [indent + line]
    limit = WIDTH - len(indent)
    candidates: list[tuple[int, int]] = []
    depth = 0
    for position, character in enumerate(line):
        if character in "([{":
            depth += 1
        elif character in ")]}":
            depth -= 1
        elif (
            character == " "
            and 0 < position <= limit
            and (line[position - 1] == "," or re.match(r" (?:[-+*/?:^]|&&|\|\||&|\|) ", line[position:]))
        ):
            candidates.append((depth, position))
    good = [c for c in candidates if c[1] > limit // 3] or candidates
    if not good:
        return [indent + line]
    shallowest = min(depth for depth, _ in good)
    position = max(p for depth, p in good if depth == shallowest)
    first, rest = line[:position], line[position + 1 :]
    return [indent + first, *code(rest, hang, hang)]


def comment(text: str, first: str, rest: str) -> list[str]:
    """A comment wrapped at WIDTH; `first` and `rest` start its first and its further lines."""
    if text and len(first) + len(text) <= WIDTH and text.isprintable() and text == text.strip():
        return [first + text]  # as below, and quicker
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=first,
        subsequent_indent=rest,
        break_long_words=False,
        break_on_hyphens=False,
    ) or [first.rstrip()]
