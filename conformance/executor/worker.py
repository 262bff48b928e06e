"""What a process of a pool does: a job, and a look at its own memory."""

from __future__ import annotations

import signal

from conformance.executor.jobs import Job, Result, perform
from conformance.memory import give_back, resident

LARGE = 400 * 2**20
"""Bytes from which on a process may have grown."""
GROWTH = 2.0
"""How many times what it held after its first job a process that has grown holds."""

_first = 0


def leave_interrupts_to_the_parent() -> None:
    """Ctrl-C reaches all processes of a terminal, also those in the middle of a driver."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def perform_and_tell(job: Job) -> tuple[Result, bool]:
    """The job's result, and whether this process has grown so much that another should go on."""
    global _first
    result = perform(job)
    give_back()
    held = resident()
    _first = _first or held
    return result, has_grown(_first, held)


def has_grown(first: int, held: int) -> bool:
    """Whether a process that held some bytes after its first job holds far more now."""
    return held > max(LARGE, GROWTH * first)
