"""What time is measured by.

A software driver computes on a thread of its own. That thread's CPU time is the clock: other programs do not
change it, and neither do Python, the driver's queue and threads that wait, whose share differs from launch to
launch.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

from codegen.thread_times import cpu_seconds, threads

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
        before, start = {t: cpu_seconds(t) for t in threads()}, time.process_time()
        launch()
        whole = time.process_time() - start
        spent = {t: cpu_seconds(t) - before[t] for t in before}
        busiest = max(spent, key=lambda t: spent[t], default=0)
        if spent and spent[busiest] >= SHARE * whole:
            return partial(cpu_seconds, busiest), "CPU time of the driver's computing thread"
    return time.process_time, "CPU time of the process"
