"""Which vendored functions would change with an update, and by how much their values do.

A function is compared as it stands in the files, edits included, with what it needs. Where that code is the
same its values are; otherwise both are executed on the same points.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from codegen.emit.definition import Definition, reached, read_definitions
from codegen.vendor.lock import Lock, Promise

_WORD = re.compile(r"\w+")
_PRECISION = re.compile(r"\b(?:highp|mediump) ")

FLOOR = 1e-30
"""Below it values are as good as 0, and on some drivers are."""

Code = tuple[tuple[str, ...], ...]
"""Definitions without comments, dependencies first."""


@dataclass(frozen=True)
class Difference:
    """How far two texts of a function are apart on one driver.

    points        inputs that both took
    absolute      largest difference of a component of the result
    relative      largest difference divided by the larger of the two values, which counts as FLOOR at least
    where         the inputs of the largest absolute difference, words in hex
    non_finite    results that were not finite: old, new
    """

    driver: str
    points: int
    absolute: float
    relative: float
    where: str
    non_finite: tuple[int, int] = (0, 0)


@dataclass
class Change:
    """What becomes of one function.

    kind         added, removed, signature, structs, code or promise
    dialects     where its code differs
    differences  dialect -> what executing both gave, or a sentence why that was not done
    """

    function: str
    kind: str
    old: Promise | None
    new: Promise | None
    dialects: list[str] = field(default_factory=list)
    differences: dict[str, Difference | str] = field(default_factory=dict)


Compare = Callable[[str, str, Code, Code], "Difference | str"]
"""Function, dialect ("glsl/430"), old and new code -> their difference, or a sentence."""


def changes(
    old_lock: Lock,
    new_lock: Lock,
    old: Mapping[str, Sequence[str]],
    new: Mapping[str, Sequence[str]],
    compare: Compare,
) -> list[Change]:
    """Every function that an update would change, by name.

    old, new  texts by dialect; one whose files are missing is left out
    compare   executes two codes; asked once for codes that differ in precision qualifiers only
    """
    texts = {d: (_by_name(old[d]), _by_name(new.get(d, ()))) for d in old if old[d]}
    return [
        change
        for name in sorted({*old_lock.functions, *new_lock.functions})
        if (change := _change(name, old_lock, new_lock, texts, compare)) is not None
    ]


def _change(
    name: str,
    old_lock: Lock,
    new_lock: Lock,
    texts: Mapping[str, tuple[dict[str, Definition], dict[str, Definition]]],
    compare: Compare,
) -> Change | None:
    old, new = old_lock.functions.get(name), new_lock.functions.get(name)
    if old is None or new is None:
        return Change(name, "added" if old is None else "removed", old, new)
    change = Change(name, "promise", old, new)
    emitted = old_lock.options.prefix + name
    done: dict[tuple[Code, Code, str], Difference | str] = {}
    for d, (before, after) in texts.items():
        if emitted not in after:
            continue
        first, second = closure(emitted, before), closure(emitted, after)
        if first == second:
            continue
        change.kind = "code"
        change.dialects.append(d)
        if old.signature != new.signature:
            change.kind = "signature"
        elif altered := _altered_structs(old_lock, new_lock, second):
            change.kind = "structs"
            change.differences[d] = (
                f"fields of {', '.join(altered)} changed; both cannot take the same inputs"
            )
        elif not first:
            change.differences[d] = "its definition was not found in the file, so it was not executed"
        else:
            key = _plain(first), _plain(second), d.partition("/")[0]
            if key not in done:
                done[key] = compare(name, d, first, second)
            change.differences[d] = done[key]
    return change if change.dialects or old.errors != new.errors else None


def closure(name: str, definitions: Mapping[str, Definition]) -> Code:
    """A definition and all that it needs, without comments, in the order of the text; empty for no such."""
    return tuple(d.code for d in reached(name, definitions.values()))


def _by_name(texts: Sequence[str]) -> dict[str, Definition]:
    """Definitions of several files in an order in which each comes after those it needs.

    Files of one function each repeat what they share; the first one counts, and sorts before its users.
    """
    found: dict[str, Definition] = {}
    for text in texts:
        for d in read_definitions(text):
            found.setdefault(d.name, d)
    return dict(_sorted(found))


def _sorted(found: Mapping[str, Definition]) -> Iterator[tuple[str, Definition]]:
    done: set[str] = set()

    def visit(name: str) -> Iterator[tuple[str, Definition]]:
        if name in done:
            return
        done.add(name)
        for word in dict.fromkeys(_WORD.findall("\n".join(found[name].code))):
            if word in found:
                yield from visit(word)
        yield name, found[name]

    for name in found:
        yield from visit(name)


def _altered_structs(old: Lock, new: Lock, code: Code) -> list[str]:
    """Structs in the code whose fields the locks tell differently."""
    words = {word for lines in code for line in lines for word in _WORD.findall(line)}
    return [
        name
        for name, fields in new.structs.items()
        if new.options.prefix + name in words and old.structs.get(name, fields) != fields
    ]


def _plain(code: Code) -> Code:
    return tuple(tuple(_PRECISION.sub("", line) for line in lines) for lines in code)
