"""Results of operations by what they were computed from, without holding what nobody else holds.

An operation on the same values is one value, however often it is written. Keeping every value for that would
fill hundreds of megabytes, and the arrays of each operation would come from memory instead of the cache. So a
value that nobody holds is dropped, and computed again should it be asked for: it is the same value then, and
has the same number and the same causes, which name the first line. What forks is kept: a fork counts once.
"""

from __future__ import annotations

import weakref
from collections.abc import Hashable
from typing import Any

from codegen.intervals.causes import Codes
from codegen.intervals.values import Range, Whole

FORKS = ("floor", "i32()", "u32()")
"""Operations that count as a fork and give numbers; comparisons give truth values, which are kept."""


_NUMBERS = (Range, Whole)


class _Droppable(weakref.ref[Any]):
    """A result as long as others hold it; its number and its causes stay."""

    __slots__ = ("cause", "number")
    number: int
    cause: Codes


class Memory:
    """Key of an operation, its name first -> its result.

    forgets  whether results that nobody holds are dropped
    """

    def __init__(self, forgets: bool) -> None:
        self.forgets = forgets
        self._results: dict[Hashable, Any] = {}

    def recall(self, key: Hashable) -> Any:
        """The result of an operation; None where there is none, or it was dropped."""
        found = self._results.get(key)
        return found() if type(found) is _Droppable else found

    def keep(self, key: tuple[Any, ...], value: Any) -> Any:
        """The result, noted under its key; with its old number and causes where it was computed before."""
        if self.forgets and type(value) in _NUMBERS and key[0] not in FORKS:
            before = self._results.get(key)
            if before is not None:
                value.number, value.cause = before.number, before.cause
            self._results[key] = droppable = _Droppable(value)
            droppable.number, droppable.cause = value.number, value.cause
        else:
            self._results[key] = value
        return value
