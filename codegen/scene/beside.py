"""Work beside the search: in a process of its own where a second core may be idle.

A fork has everything that the work needs without a copy; only what it makes travels back. Drivers do not
survive a fork, so nothing is forked while one is open.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import warnings
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import TypeVar

Result = TypeVar("Result")


def beside(make: Callable[[], Result], *, forked: bool) -> Callable[[], Result]:
    """Start the work; what is given back waits for its result.

    make    the work; done by whoever waits where nothing can be forked or the process ends without a result
    forked  whether a process may be forked
    """
    if not forked or "fork" not in multiprocessing.get_all_start_methods() or os.cpu_count() == 1:
        return make
    context = multiprocessing.get_context("fork")
    receiving, sending = context.Pipe(duplex=False)
    process = context.Process(target=_worked, args=(make, sending), daemon=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads: those of BLAS survive a fork
        process.start()
    sending.close()

    def result() -> Result:
        try:
            found: Result = receiving.recv()
        except (EOFError, OSError):
            found = make()  # an error is raised here as it is
        process.join()
        return found

    return result


def _worked(make: Callable[[], object], sending: Connection) -> None:
    """The process: it sends the result, or ends without one, and does nothing else on its way out."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # who waits ends this process
        gc.freeze()
        sending.send(make())
    finally:
        os._exit(0)
