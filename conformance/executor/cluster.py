"""Jobs on the workers of a Dask scheduler; needs the package distributed (the extra "cluster").

Every worker says by itself which targets it can run and which sources it has: a plugin, installed on all
present and future workers, probes the drivers and declares one resource per target, named for the target and
the hash of the library's sources. A job asks for the resource of its target, so a worker without the driver,
or with other sources, is never given it. One unit per worker: a device does one thing at a time.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable, Iterator
from queue import Empty, SimpleQueue
from typing import Any

from distributed import Client, Worker, WorkerPlugin

from codegen.library import load_library
from conformance.executor.jobs import DEVICELESS, Job, Result, available, perform
from targets import TARGETS

RETRIES = 2
"""How often a job is tried again that failed without a result; Dask itself handles the loss of a worker."""
QUEUED_PER_WORKER = 4
"""Jobs handed to the scheduler ahead, per worker."""
CONNECT_SECONDS = 15
ANNOUNCE_SECONDS = 60
"""How long to wait for the workers to say what they can do."""
PATIENCE_SECONDS = 60.0
"""How long work that was handed out waits for a worker that can do it, after the last one is gone."""


def resource(target: str, source: str) -> str:
    """Name of the resource that a worker with the target's driver and those sources declares."""
    return f"vair-{target}-{source}"


def source_hash() -> str:
    """The hash of the whole library's sources in this process."""
    return load_library().select().source_hash


_client: Any = Client  # its methods are not typed


class DriverResources(WorkerPlugin):
    """Declares a worker's targets as resources; `only` leaves others out, for tests."""

    name = "vair-drivers"

    def __init__(self, only: dict[str, tuple[str, ...]] | None = None) -> None:
        """only  worker's name -> the targets it may declare; workers that are not named declare all"""
        self.only = only or {}

    async def setup(self, worker: Worker) -> None:
        """Probe the drivers beside the event loop, then declare them."""
        names = self.only.get(str(worker.name), (*DEVICELESS, *TARGETS))
        here = await asyncio.to_thread(lambda: [name for name in names if not available(name)])
        source = await asyncio.to_thread(source_hash)
        await worker.set_resources(**{resource(name, source): 1.0 for name in here})


class Cluster:
    """The workers of a scheduler, found at an address such as tcp://192.0.2.1:8786."""

    def __init__(self, address: str, plugin: DriverResources | None = None) -> None:
        """Raises OSError where no scheduler answers."""
        self.client: Any = _client(address, timeout=CONNECT_SECONDS, set_as_default=False)
        self.source = source_hash()
        self.client.register_plugin(plugin or DriverResources())

    def close(self) -> None:
        """Leave the scheduler; its workers stay."""
        self.client.close()

    def resources(self) -> dict[str, dict[str, float]]:
        """What each worker has declared, by its name."""
        info: dict[str, Any] = self.client.scheduler_info()
        return {str(w["name"]): dict(w["resources"]) for w in info["workers"].values()}

    def missing(self, target: str) -> str:
        """Empty if a worker can do the target's work; else the sentence that says that none can."""
        wanted = self.wanted(target)
        declared = self.resources()
        if any(wanted.keys() <= names.keys() for names in declared.values()):
            return ""
        others = any(name.startswith(f"vair-{target}-") for names in declared.values() for name in names)
        why = "has the same sources and the driver" if others else "has the driver"
        return f"none of {len(declared)} workers {why} of {target}"

    def wanted(self, target: str) -> dict[str, float]:
        """The resources that the work of a target, or of several, asks of one worker."""
        return {resource(name, self.source): 1.0 for name in target.split(",")}

    def run(self, jobs: Iterable[Job]) -> Iterator[Result]:
        """One result per job; a job whose worker is lost is given to another."""
        self._wait_for_announcements()
        waiting = iter(jobs)
        absent: dict[str, str] = {}
        done: SimpleQueue[Any] = SimpleQueue()
        under_way: dict[Any, Job] = {}
        left_alone: set[str] = set()
        more = True
        while more or under_way:
            room = QUEUED_PER_WORKER * max(len(self.resources()), 1)
            while more and len(under_way) < room:
                job = next(waiting, None)
                if job is None:
                    more = False
                    break
                if job.target not in absent:
                    absent[job.target] = self.missing(job.target)
                if absent[job.target]:
                    yield Result(job, {}, absent[job.target])
                    continue
                future = self._submit(job)
                under_way[future] = job
                future.add_done_callback(done.put)
            if not under_way:
                continue
            try:
                future = done.get(timeout=PATIENCE_SECONDS)
            except Empty:
                given_up = self._given_up(under_way, left_alone)
                if given_up:
                    absent.clear()  # what still waits is asked about anew
                yield from given_up
                continue
            job = under_way.pop(future, None)
            if job is None:
                continue  # it was given up, and is told to be cancelled
            if future.status == "finished":
                yield future.result()
            else:
                yield Result(job, {}, f"the cluster gave it up: {future.exception()}")

    def _given_up(self, under_way: dict[Any, Job], left_alone: set[str]) -> list[Result]:
        """Jobs that no worker can do, nor could one PATIENCE_SECONDS ago, taken from those under way.

        left_alone  targets that no worker could serve when this was asked last; renewed
        """
        absent = {job.target: self.missing(job.target) for job in under_way.values()}
        absent = {target: reason for target, reason in absent.items() if reason}
        lost = {f: job for f, job in under_way.items() if job.target in left_alone & absent.keys()}
        for future in lost:
            del under_way[future]
            future.cancel()
        left_alone.clear()
        left_alone.update(absent)
        return [Result(job, {}, absent[job.target]) for job in lost.values()]

    def _submit(self, job: Job) -> Any:
        # The key is the job: the same job asked for twice is done once.
        wanted = self.wanted(job.target)
        return self.client.submit(perform, job, key=job.identity, resources=wanted, retries=RETRIES)

    def _wait_for_announcements(self) -> None:
        deadline = time.monotonic() + ANNOUNCE_SECONDS
        while time.monotonic() < deadline:
            declared = self.resources()
            if declared and all(declared.values()):
                return
            time.sleep(0.2)
