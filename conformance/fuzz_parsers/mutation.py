"""Bytes to a file. The same bytes give the same file, so that a finding is replayed by its bytes.

The first byte chooses: the other bytes as they are; a seed with ranges of it replaced; or a seed's tree with
keys dropped, doubled, renamed and values replaced by others that a reader may stumble over.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

VALUES: tuple[Any, ...] = (
    0, 1, -1, 2, 3, 7, 64, 65, 1000, 2**31, 2**32, 2**63, 10**400, True, False, None,
    0.0, -0.0, 0.5, 1.0, 1e-320, 1e38, 1e308, float("inf"), float("-inf"), float("nan"),
    "", " ", "x", "exact", "glsl", "wgsl", "..", "/", "/etc/passwd", "../x", "a/../../x", "a\x00b", "\n", "é",
    "\ud800", "{0}", "%s", "x" * 300, "con", "1e5", "nan",
    [], {}, [0], [[]], [{}], {"": 0}, [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1e308, 1e308, 1e308], [0.0, 1.0],
    ["glsl"], ["glsl", "glsl"], {"min": 0.0, "max": 1.0}, {"min": 1.0, "max": 0.0}, {"min": 0.1},
    [1, "x", None],
)  # fmt: skip
DEEPEST = 3000
"""Brackets of a value that is nested deeper than Python recurses."""


@dataclass
class Choices:
    """Choices made by bytes; zeros once they are used up."""

    data: bytes
    at: int = 0

    def number(self, below: int) -> int:
        """A number from 0 to below - 1, of two bytes."""
        taken = self.data[self.at : self.at + 2].ljust(2, b"\0")
        self.at += 2
        return int.from_bytes(taken, "big") % max(below, 1)

    def bytes(self, most: int) -> bytes:
        """Some of the bytes that are left."""
        count = self.number(most + 1)
        taken = self.data[self.at : self.at + count]
        self.at += count
        return taken

    @property
    def left(self) -> bool:
        return self.at < len(self.data)


def mutated(
    data: bytes, seeds: Sequence[bytes], trees: Sequence[Any], write: Callable[[Any], bytes] | None
) -> bytes:
    """The file that these bytes stand for.

    trees  the seeds as trees; write  what makes a file of one; None where there are no trees
    """
    choices = Choices(data)
    kind = choices.number(4)
    if kind == 0 or (kind >= 2 and write is None):
        return data[2:] if kind == 0 else spliced(choices, seeds)
    if kind == 1:
        return spliced(choices, seeds)
    assert write is not None
    tree = copied(trees[choices.number(len(trees))])
    for _ in range(1 + choices.number(4)):
        tree = altered(tree, choices)
        if not choices.left:
            break
    return write(tree)


def spliced(choices: Choices, seeds: Sequence[bytes]) -> bytes:
    """A seed with some ranges replaced by other bytes or by parts of seeds."""
    text = seeds[choices.number(len(seeds))]
    for _ in range(1 + choices.number(6)):
        start = choices.number(len(text) + 1)
        end = start + choices.number(24)
        how = choices.number(4)
        if how == 0:
            part = choices.bytes(32)
        elif how == 1:
            other = seeds[choices.number(len(seeds))]
            begin = choices.number(len(other) + 1)
            part = other[begin : begin + choices.number(200)]
        elif how == 2:
            part = text[start:end] * (1 + choices.number(4))
        else:
            part = bytes([choices.number(256)]) * choices.number(DEEPEST)
        text = text[:start] + part + text[end:]
        if not choices.left:
            break
    return text


def altered(tree: Any, choices: Choices) -> Any:
    """The tree with one node changed."""
    path = []
    node = tree
    while isinstance(node, dict | list) and node and choices.number(5):
        key: Any = (
            list(node)[choices.number(len(node))] if isinstance(node, dict) else choices.number(len(node))
        )
        path.append((node, key))
        node = node[key]
    if not path:
        return tree if choices.number(4) else copied(VALUES[choices.number(len(VALUES))])
    parent, key = path[-1]
    how = choices.number(6)
    if how == 0:
        del parent[key]
    elif how == 1 and isinstance(parent, dict):
        parent[str(key) + "x"] = parent.pop(key)
    elif how == 2 and isinstance(parent, dict):
        parent[choices.bytes(12).decode("latin-1")] = node
    elif how == 3:
        other, inner = path[choices.number(len(path))]
        parent[key] = copied(other[inner]) if inner in _keys(other) else 0
    elif how == 4 and isinstance(node, str):
        parent[key] = node + choices.bytes(12).decode("latin-1")
    else:
        parent[key] = copied(VALUES[choices.number(len(VALUES))])
    return tree


def copied(tree: Any) -> Any:
    """A tree of its own; several times faster than copy.deepcopy, which looks for circles."""
    if isinstance(tree, dict):
        return {key: copied(value) for key, value in tree.items()}
    return [copied(value) for value in tree] if isinstance(tree, list) else tree


def _keys(node: Any) -> Any:
    return node if isinstance(node, dict) else range(len(node))
