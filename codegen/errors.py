"""What a user may be told: one clear sentence that says where and what is nearest."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

LONGEST = 1000
"""Characters of a sentence: what it quotes of a file may be of any length."""


class UserError(Exception):
    """Bad input or usage; the command line prints the sentence and exits with status 2.

    It quotes files that may hold anything: characters that are not printed are written as escapes.
    """

    def __init__(self, sentence: str) -> None:
        super().__init__(_one_line(sentence))


def _one_line(text: str) -> str:
    if text.isprintable() and len(text) <= LONGEST:
        return text
    shown = "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode() for c in text[: LONGEST + 1]
    )
    return shown if len(shown) <= LONGEST else f"{shown[:LONGEST]} ..."


@dataclass(frozen=True)
class Place:
    """A position in a source file: path as shown to the user, 1-based line, 1-based column."""

    path: str
    line: int
    column: int = 1
    text: str = ""

    def __str__(self) -> str:
        return f"{self.path}:{self.line}:{self.column}"


class SourceError(UserError):
    """A sentence about a place in the single source, printed with the line and a caret under it."""

    def __init__(self, place: Place, sentence: str) -> None:
        self.place = place
        self.sentence = sentence
        caret = f"\n    {place.text}\n    {' ' * (place.column - 1)}^" if place.text else ""
        Exception.__init__(self, f"{place}: {sentence}{caret}")


def nearest(name: str, valid: Iterable[str]) -> str:
    """The hint '; did you mean "x"?' for the valid name nearest to `name`, or the list where it is short."""
    names = sorted(valid)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    if close:
        return f'; did you mean "{close[0]}"?'
    if 0 < len(names) <= 12:
        return f"; valid names: {', '.join(names)}"
    return ""


def unknown(kind: str, name: str, valid: Iterable[str]) -> UserError:
    """The error for a name that is not among the valid ones."""
    return UserError(f'unknown {kind} "{name}"{nearest(name, valid)}')


def check_names(
    given: Iterable[str], allowed: Iterable[str], needed: Iterable[str], odd: str, lacking: str
) -> None:
    """Refuse names that are not allowed, and needed names that are not given.

    odd, lacking  how the two sentences begin: 'f has no parameter', 'f needs'
    """
    given, allowed = list(given), list(allowed)
    for name in given:
        if name not in allowed:
            raise UserError(f'{odd} "{name}"{nearest(name, allowed)}')
    missing = [name for name in needed if name not in given]
    if missing:
        raise UserError(f"{lacking} {', '.join(missing)}")
