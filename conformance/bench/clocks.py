"""What time is measured by.

A software driver computes on a thread of its own. That thread's CPU time is the clock: other programs do not
change it, and neither do Python, the driver's queue and threads that wait, whose share differs from launch to
launch.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

Clock = Callable[[], float]

SHARE = 0.8
"""A thread that does at least this share of the process's work is the one that computes."""
TRIES = 5
"""Launches in which it may show: a driver may compile beside the first ones, or start a thread."""
SECONDS = 0.02
"""How long the launch should take that shows which thread this is."""


def driver_clock(launch: Callable[[], None]) -> tuple[Clock, str]:
    """The clock of a software driver, and its name.

    launch   runs a kernel that takes long
    returns  the CPU time of the computing thread, or of the process where no one thread computes
    """
    for _ in range(TRIES):
        threads = _threads()
        before, start = {t: _read(t) for t in threads}, time.process_time()
        launch()
        whole = time.process_time() - start
        spent = {t: _read(t) - before[t] for t in threads}
        busiest = max(spent, key=lambda t: spent[t], default=0)
        if spent and spent[busiest] >= SHARE * whole:
            return partial(_read, busiest), "CPU time of the driver's computing thread"
    return time.process_time, "CPU time of the process"


def _threads() -> list[int]:
    """The process's threads, where the system tells."""
    folder = Path("/proc/self/task")
    return [int(name) for name in os.listdir(folder)] if folder.is_dir() else []


def _read(thread: int) -> float:
    """CPU seconds of a thread by Linux's number of its clock; 0 for a thread that has ended."""
    try:
        return time.clock_gettime((~thread << 3) | 6)
    except OSError:
        return 0.0
