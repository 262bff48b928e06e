"""Tasks for tests of executors: they say which worker did them."""

from __future__ import annotations

import os
import time
from typing import Any

from conformance.executor import Job


def who(job: Job) -> dict[str, Any]:
    """The name of the worker that does this job."""
    from distributed import get_worker

    time.sleep(0.05)
    return {"worker": str(get_worker().name)}


def slow(job: Job) -> dict[str, Any]:
    """A result that takes a while: the square of the seed, and the process that found it."""
    time.sleep(0.3)
    return {"square": job.seed * job.seed, "pid": os.getpid()}


_hoard: list[bytearray] = []


def hoard(job: Job) -> dict[str, Any]:
    """Keeps 250 MB for ever, as drivers keep what they compiled; who did it, and how often."""
    _hoard.append(bytearray(b"x") * 250_000_000)
    return {"pid": os.getpid(), "kept": len(_hoard)}
