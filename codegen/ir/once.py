"""Classes whose objects are keys of tables: each computes its hash once, and is equal to itself at once."""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter
from typing import Any, TypeVar

Node = TypeVar("Node")


def hashed_once(kind: type[Node]) -> type[Node]:
    """A frozen dataclass, made without comparison: objects are equal where their compared fields are, and
    remember their hash. Trees are keys, and share parts."""
    known_fields = kind.__dataclass_fields__  # type: ignore[attr-defined]
    fields = tuple(known_fields)
    compared = [name for name, field in known_fields.items() if field.compare]
    content: Callable[[Node], object] = attrgetter(*compared)

    def hashed(self: Node) -> int:
        known: dict[str, Any] = self.__dict__
        if "_hash" not in known:
            known["_hash"] = hash(content(self))
        found: int = known["_hash"]
        return found

    def equal(self: Node, other: object) -> bool:
        if self is other:
            return True
        return content(self) == content(other) if other.__class__ is self.__class__ else NotImplemented

    def state(self: Node) -> dict[str, Any]:
        """What another process may know: hashes of texts differ from process to process."""
        return {name: self.__dict__[name] for name in fields}

    kind.__hash__ = hashed  # type: ignore[assignment]
    kind.__eq__ = equal  # type: ignore[assignment]
    kind.__getstate__ = state  # type: ignore[method-assign, assignment]
    return kind
