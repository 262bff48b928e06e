"""The programs that a runtime keeps, so that a text is built once, and not more of them than memory bears."""

from collections import OrderedDict
from collections.abc import Callable
from typing import Any, Generic, TypeVar
from weakref import WeakSet

PROGRAMS_KEPT = 256
"""Built programs per runtime: more than the functions of the library; about half a megabyte each."""

K = TypeVar("K")
P = TypeVar("P")


class Programs(Generic[K, P]):
    """Built programs by their text; the one that was not asked for longest is dropped first.

    What is dropped lives on where a prepared program still holds it. Not for several threads at once.
    """

    def __init__(self, most: int = PROGRAMS_KEPT) -> None:
        self.most = most
        self._kept: OrderedDict[K, P] = OrderedDict()
        _every.add(self)

    def __len__(self) -> int:
        return len(self._kept)

    def find(self, key: K, build: Callable[[], P]) -> P:
        """The program of a key, built if it is not kept; what build raises is raised, and nothing kept."""
        if key not in self._kept:
            built = build()
            while self._kept and len(self._kept) >= self.most:
                self._kept.popitem(last=False)
            self._kept[key] = built
        self._kept.move_to_end(key)
        return self._kept[key]

    def forget(self) -> None:
        """Keep none of them."""
        self._kept.clear()


_every: WeakSet[Programs[Any, Any]] = WeakSet()


def forget_programs() -> None:
    """Drop what the runtimes of this process keep for another run; not while one is building."""
    for programs in list(_every):
        programs.forget()
