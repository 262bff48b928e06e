"""Large arrays that are kept for long, in large pages: the first touch of a small page takes longer than what
is computed there, and a copy of a process has fewer pages to share.
"""

from __future__ import annotations

import mmap
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]
CHUNK = 32 * 2**20
"""Bytes that are asked for at once."""
LEAST = 2**14
"""Bytes from which on an array is moved."""
ALIGNED = 64


def hold_freed() -> None:
    """Let what is freed be used again: an allocator like glibc's gives large blocks back to the system until
    it has seen a larger one come and go, which costs nothing where that is never touched."""
    np.empty(CHUNK - 2**16, np.uint8)


class Pages:
    """Moves arrays into large pages, where the system offers them; elsewhere they stay where they are."""

    def __init__(self) -> None:
        self._chunk: mmap.mmap | None = None
        self._used = CHUNK

    def moved(self, a: Array) -> Array:
        """The array, or a copy in the same order; a part of another one stays a part of it."""
        base = a if a.base is None else a.base
        if not LEAST <= a.nbytes <= CHUNK or getattr(base, "nbytes", 0) != a.nbytes or a.dtype.hasobject:
            return a
        if not a.flags.forc or not hasattr(mmap, "MADV_HUGEPAGE"):
            return a
        if self._used + a.nbytes > CHUNK:
            self._chunk, self._used = mmap.mmap(-1, CHUNK, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS), 0
            self._chunk.madvise(mmap.MADV_HUGEPAGE)
        assert self._chunk is not None
        found: Array = np.ndarray(a.shape, a.dtype, self._chunk, self._used, a.strides)
        np.copyto(found, a)
        self._used += -(-a.nbytes // ALIGNED) * ALIGNED
        return found
