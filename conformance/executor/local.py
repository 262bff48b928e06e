"""Executors on this machine: in this process, or in processes of their own."""

from __future__ import annotations

import multiprocessing
from collections import deque
from collections.abc import Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Protocol

from conformance.executor.jobs import Job, Result, available, perform
from conformance.executor.worker import leave_interrupts_to_the_parent, perform_and_tell

ATTEMPTS = 3
"""How often a job is tried whose worker dies; then it is reported as failed."""
QUEUED_PER_WORKER = 2
"""Jobs handed out ahead, so that no worker waits; all of them are tried again when a worker dies."""


class Executor(Protocol):
    """Something that performs jobs."""

    def run(self, jobs: Iterable[Job]) -> Iterator[Result]:
        """One result per job, in any order. Jobs may be done twice, results are given once."""
        ...


class Here:
    """This process, one job after the other."""

    def run(self, jobs: Iterable[Job]) -> Iterator[Result]:
        for job in jobs:
            missing = available(job.target)
            yield Result(job, {}, missing) if missing else perform(job)


class Processes:
    """A pool of processes; each opens its own devices. A process that dies loses nothing.

    Drivers keep some memory of every program that they compile. Once a process has grown by that, the pool
    ends when it is done with what was handed out, and another one goes on.

    Interrupted, it ends when its workers are done with the jobs that they have; interrupted again, at once.
    """

    def __init__(self, workers: int = 2) -> None:
        self.workers = workers

    def run(self, jobs: Iterable[Job]) -> Iterator[Result]:
        waiting: deque[Job] = deque()
        for job in jobs:
            missing = available(job.target)
            if missing:
                yield Result(job, {}, missing)
            else:
                waiting.append(job)
        while waiting:
            died = yield from self._pool(waiting)
            # Any of them may have killed the process: alone, a fatal job takes no other with it.
            for job in died:
                yield from self._alone(job)

    def _alone(self, job: Job) -> Iterator[Result]:
        for _ in range(ATTEMPTS - 1):
            died = yield from self._pool(deque([job]))
            if not died:
                return
        yield Result(job, {}, f"the worker died in each of {ATTEMPTS} attempts")

    def _pool(self, waiting: deque[Job]) -> Generator[Result, None, list[Job]]:
        """Run what waits in one pool, until a process has grown or dies; returns what was under way then."""
        spawn = multiprocessing.get_context("spawn")  # drivers do not survive a fork
        under_way: dict[Future[tuple[Result, bool]], Job] = {}
        died: list[Job] = []
        ends = False
        pool = ProcessPoolExecutor(
            min(self.workers, len(waiting)), mp_context=spawn, initializer=leave_interrupts_to_the_parent
        )
        try:
            while under_way or (waiting and not ends):
                while waiting and not ends and len(under_way) < self.workers * QUEUED_PER_WORKER:
                    try:
                        future = pool.submit(perform_and_tell, waiting[0])
                    except BrokenProcessPool:
                        if not under_way:
                            return died  # an idle process died: another pool goes on
                        break  # what is under way will say so
                    under_way[future] = waiting.popleft()
                finished, _ = wait(under_way, return_when=FIRST_COMPLETED)
                for future in finished:
                    job = under_way.pop(future)
                    try:
                        result, has_grown = future.result()
                    except BrokenProcessPool:
                        died.append(job)
                        ends = True
                    else:
                        ends |= has_grown
                        yield result
        finally:
            try:
                pool.shutdown(cancel_futures=True)
            except KeyboardInterrupt:
                # Workers that nobody tells to end would be waited for at exit, for ever.
                for process in multiprocessing.active_children():
                    process.kill()
                raise
        return died
