"""What one function may cost a driver: a compiler that comes to no end is ended, before the machine is.

Limits of the process, so that they hold while the driver's own code runs. A process that meets one ends; its
function then counts as not executed, and a new process goes on with the next.
"""

from __future__ import annotations

import resource
import time

CPU_SECONDS = 120
"""Of one function, references and intervals included; the slowest takes some 20 s."""
BYTES = 4 << 30
"""Of memory that the process has to itself; the largest takes some 0.7 GiB."""


def limit_memory(most: int = BYTES) -> None:
    """End this process, or fail its allocations, beyond so many bytes of its own."""
    _, hard = resource.getrlimit(resource.RLIMIT_DATA)
    resource.setrlimit(resource.RLIMIT_DATA, (_at_most(most, hard), hard))


def limit_time(seconds: int = CPU_SECONDS) -> None:
    """End this process when it has used so many more seconds of processor time, of all its threads."""
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (_at_most(int(time.process_time()) + seconds, hard), hard))


def _at_most(wanted: int, hard: int) -> int:
    return wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
