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
from collections.abc import Callable, Sequence
from functools import partial
from multiprocessing.connection import Connection
from multiprocessing.context import ForkProcess
from typing import Any, TypeVar

Result = TypeVar("Result")
First = TypeVar("First")
Second = TypeVar("Second")
Third = TypeVar("Third")


class Beside:
    """Works in processes of their own; a context: at its end, what nobody waited for is given up.

    forked  whether a process may be forked; else the works are done by whoever waits for them
    """

    def __init__(self, *, forked: bool) -> None:
        self._forked = forked and "fork" in multiprocessing.get_all_start_methods() and os.cpu_count() != 1
        self._open: list[tuple[ForkProcess, Connection]] = []

    def __enter__(self) -> Beside:
        return self

    def __exit__(self, *_: object) -> None:
        for process, receiving in self._open:
            receiving.close()
            process.terminate()
            process.join()

    def one(self, make: Callable[[], Result]) -> Callable[[], Result]:
        """Start the work; what is given back waits for its result.

        The work is done by whoever waits where nothing can be forked or the process ends without a result.
        """
        (result,) = self.each([make])
        return result

    def in_turn(
        self, first: Callable[[], First], second: Callable[[], Second], third: Callable[[], Third]
    ) -> tuple[Callable[[], First], Callable[[], Second], Callable[[], Third]]:
        """The same for works that one process does in turn; it goes on while the results before are used."""
        works: list[Callable[[], Any]] = [first, second, third]
        one, two, three = self.each(works)
        return one, two, three

    def each(self, works: Sequence[Callable[[], Result]]) -> Sequence[Callable[[], Result]]:
        """The same for any number of works of one kind."""
        if not self._forked or not works:
            return works
        context = multiprocessing.get_context("fork")
        receiving, sending = context.Pipe(duplex=False)
        process = context.Process(target=_worked, args=(works, sending), daemon=True)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of threads: those of BLAS survive a fork
            process.start()
        sending.close()
        self._open.append((process, receiving))
        received: list[Result] = []

        def result(number: int) -> Result:
            try:
                while len(received) <= number:
                    received.append(receiving.recv())
            except (EOFError, OSError):
                return works[number]()  # an error is raised here as it is
            return received[number]

        return [partial(result, number) for number in range(len(works))]


def _worked(works: Sequence[Callable[[], object]], sending: Connection) -> None:
    """The process: it sends the results, or ends without one, and does nothing else on its way out."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # who waits ends this process
        gc.freeze()
        for make in works:
            sending.send(make())
    finally:
        os._exit(0)
