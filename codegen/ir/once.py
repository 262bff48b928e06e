"""Classes whose objects are keys of tables: each computes its hash once, and is equal to itself at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Node = TypeVar("Node")


def hashed_once(kind: type[Node]) -> type[Node]:
    """A frozen dataclass whose objects remember their hash: trees are keys, and share parts."""
    plain: Callable[[Node], int] = kind.__hash__
    same: Callable[[Node, object], bool] = kind.__eq__
    fields = tuple(kind.__dataclass_fields__)  # type: ignore[attr-defined]

    def hashed(self: Node) -> int:
        known: dict[str, Any] = self.__dict__
        if "_hash" not in known:
            known["_hash"] = plain(self)
        found: int = known["_hash"]
        return found

    def equal(self: Node, other: object) -> bool:
        return self is other or same(self, other)

    def state(self: Node) -> dict[str, Any]:
        """What another process may know: hashes of texts differ from process to process."""
        return {name: self.__dict__[name] for name in fields}

    kind.__hash__ = hashed  # type: ignore[assignment]
    kind.__eq__ = equal  # type: ignore[assignment]
    kind.__getstate__ = state  # type: ignore[method-assign, assignment]
    return kind
