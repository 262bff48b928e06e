"""CPU time of single threads, where the system tells it: what a software driver computes on."""

from __future__ import annotations

import os
import time
from pathlib import Path


def threads() -> list[int]:
    """The process's threads by number; none where the system does not list them."""
    folder = Path("/proc/self/task")
    return [int(name) for name in os.listdir(folder)] if folder.is_dir() else []


def cpu_seconds(thread: int) -> float:
    """CPU seconds of a thread by Linux's number of its clock; 0 for one that has ended."""
    try:
        return time.clock_gettime((~thread << 3) | 6)
    except OSError:
        return 0.0
