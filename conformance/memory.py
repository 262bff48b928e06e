"""The memory of this process: what it holds, and giving back what it no longer needs."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path


def resident() -> int:
    """Bytes of memory that this process holds; 0 where the system does not tell."""
    try:
        pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
    except OSError:
        return 0
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


def give_back() -> None:
    """Return to the system what was freed: glibc keeps hundreds of megabytes of it after compilers."""
    try:
        trim = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return  # another C library
    trim(0)
