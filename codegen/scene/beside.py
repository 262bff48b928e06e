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
from typing import Any, TypeVar

Result = TypeVar("Result")
First = TypeVar("First")
Second = TypeVar("Second")
Third = TypeVar("Third")


def beside(make: Callable[[], Result], *, forked: bool) -> Callable[[], Result]:
    """Start the work; what is given back waits for its result.

    make    the work; done by whoever waits where nothing can be forked or the process ends without a result
    forked  whether a process may be forked
    """
    (result,) = _in_turn([make], forked)
    return result


def in_turn_beside(
    first: Callable[[], First], second: Callable[[], Second], third: Callable[[], Third], *, forked: bool
) -> tuple[Callable[[], First], Callable[[], Second], Callable[[], Third]]:
    """The same for works that one process does in turn; it goes on while the results before are used."""
    one, two, three = _in_turn([first, second, third], forked)
    return one, two, three


def each_beside(works: Sequence[Callable[[], Result]], *, forked: bool) -> Sequence[Callable[[], Result]]:
    """The same for any number of works of one kind."""
    return _in_turn(works, forked) if works else ()


def _in_turn(works: Sequence[Callable[[], Any]], forked: bool) -> Sequence[Callable[[], Any]]:
    if not forked or "fork" not in multiprocessing.get_all_start_methods() or os.cpu_count() == 1:
        return works
    context = multiprocessing.get_context("fork")
    receiving, sending = context.Pipe(duplex=False)
    process = context.Process(target=_worked, args=(works, sending), daemon=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads: those of BLAS survive a fork
        process.start()
    sending.close()
    received: list[Any] = []

    def result(number: int) -> Any:
        try:
            while len(received) <= number:
                received.append(receiving.recv())
        except (EOFError, OSError):
            return works[number]()  # an error is raised here as it is
        if len(received) == len(works):
            process.join()
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
