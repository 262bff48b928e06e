"""Results of operations by what they were computed from, without holding what nobody else holds.

An operation on the same values is one value, however often it is written. Keeping every value for that would
fill hundreds of megabytes, and the arrays of each operation would come from memory instead of the cache. So a
value that nobody holds is dropped, and computed again should it be asked for: it is the same value then, and
has the same number. What forks, or has a cause, is kept: a fork counts once, a cause names the first line.
"""

from __future__ import annotations

import weakref
from collections.abc import Hashable
from typing import Any

from codegen.intervals.values import Range, Whole

FORKS = ("floor", "i32()", "u32()")
"""Operations that count as a fork and give numbers; comparisons give truth values, which are kept."""


class Memory:
    """Key of an operation, its name first -> its result.

    forgets  whether results that nobody holds are dropped
    """

    def __init__(self, forgets: bool) -> None:
        self.forgets = forgets
        self._kept: dict[Hashable, Any] = {}
        # What was dropped is None here; its number stays.
        self._seen: dict[Hashable, tuple[weakref.ref[Any], int]] = {}

    def recall(self, key: Hashable) -> Any:
        """The result of an operation; None where there is none, or it was dropped."""
        found = self._kept.get(key)
        if found is None and (seen := self._seen.get(key)) is not None:
            return seen[0]()
        return found

    def keep(self, key: tuple[Any, ...], value: Any) -> Any:
        """The result, noted under its key; with its old number where it was computed before."""
        droppable = self.forgets and isinstance(value, Range | Whole) and value.cause is None
        if not droppable or key[0] in FORKS:
            self._kept[key] = value
        else:
            seen = self._seen.get(key)
            if seen is not None:
                value.number = seen[1]
            self._seen[key] = weakref.ref(value), value.number
        return value
