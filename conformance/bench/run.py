"""Measuring drivers: a worker process per visit, whose environment makes its driver use one thread."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from codegen.errors import UserError
from codegen.library import default_root
from conformance.bench.record import complete
from conformance.bench.timing import QUICK, VISIT, Effort
from conformance.bench.vectorised import CACHE, REMARKS
from conformance.bench.visiting import all_visits
from conformance.bench.visits import MOST_VISITS
from conformance.bench.worker import Job
from targets import TargetUnavailable
from targets.drivers import driver, environment_of

ONE_THREAD = {"LP_NUM_THREADS": "1", "POCL_MAX_PTHREAD_COUNT": "1"}
WEIGHTS = {"opencl": 4, "wgsl": 2, "glsl": 1}
"""How long a target takes beside the others: PoCL compiles slowly."""

Watch = Callable[[str, dict[str, Any]], None]
"""Called with a driver's label and an event of its worker: started (total), done (what)."""


@dataclass(frozen=True)
class Place:
    """Where to measure: a target, and a driver of the catalogue by name (empty: the one it prefers)."""

    target: str
    driver: str = ""

    @property
    def label(self) -> str:
        """What it is called in messages."""
        return self.driver or self.target


@dataclass(frozen=True)
class Options:
    """What to measure on every driver; see worker.Job.

    seconds    how long all of it should take, on a machine that does nothing else
    leave_out  whether what the time does not suffice for is left out
    at_once    workers side by side
    visits     most visits to a driver, each in a process of its own
    """

    functions: tuple[str, ...] = ()
    effort: Effort = VISIT
    uniform: int = 20_000
    family: int = 2_000
    figures: int = 20_000
    seconds: float = 800.0
    leave_out: bool = False
    at_once: int = 2
    visits: int = MOST_VISITS

    @staticmethod
    def quick(functions: tuple[str, ...] = ()) -> Options:
        """Fewer rounds in a single visit, fewer inputs, no promised figures."""
        return Options(
            functions,
            QUICK,
            uniform=2_000,
            family=200,
            figures=0,
            seconds=95.0,
            leave_out=not functions,
            visits=1,
        )


def places(targets: Sequence[str], drivers: Sequence[str]) -> list[Place]:
    """Where to measure; raises UserError for a driver that cannot be timed or is not known."""
    found = [Place(target) for target in targets]
    for name in drivers:
        try:
            chosen = driver(name)
        except ValueError as e:
            raise UserError(str(e)) from None
        if chosen.kernel:
            raise UserError(f"driver {name} cannot be timed: it takes programs of another form than the rest")
        found.append(Place(chosen.target, name))
    return found


def measure(
    where: Sequence[Place], options: Options, watch: Watch = lambda label, event: None
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """Measure on these drivers.

    returns  the data of each that is here, as recorded files hold it; and by label why each other is not
    errors   UserError where a worker fails
    """
    return side_by_side(
        where,
        options.at_once,
        options.seconds,
        lambda p, seconds: _work(p, replace(options, seconds=seconds), watch),
    )


def side_by_side(
    where: Sequence[Place],
    at_once: int,
    seconds: float,
    work: Callable[[Place, float], dict[str, Any] | str],
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """What work gives for these drivers and their shares of the time, some of them side by side.

    work     (place, seconds) -> data, or the reason why a driver is not here
    returns  the data of each that is here; and by label why each other is not
    """
    queues = schedule(where, max(1, min(at_once, os.cpu_count() or 1)), seconds)

    def in_turn(queue: list[tuple[Place, float]]) -> dict[Place, dict[str, Any] | str]:
        return {p: work(p, share) for p, share in queue}

    answers: dict[Place, dict[str, Any] | str] = {}
    with ThreadPoolExecutor(len(queues)) as pool:
        for part in pool.map(in_turn, queues):
            answers |= part
    answers = {p: answers[p] for p in where}
    found = [answer for answer in answers.values() if not isinstance(answer, str)]
    missing = {p.label: answer for p, answer in answers.items() if isinstance(answer, str)}
    return found, missing


def schedule(where: Sequence[Place], at_once: int, seconds: float) -> list[list[tuple[Place, float]]]:
    """Queues of drivers that are measured side by side, each driver with its share of the time."""
    queues: list[list[Place]] = [[] for _ in range(min(at_once, len(where)))]
    for place in sorted(where, key=lambda p: -WEIGHTS[p.target]):
        min(queues, key=lambda queue: sum(WEIGHTS[p.target] for p in queue)).append(place)
    return [
        [(p, seconds * WEIGHTS[p.target] / sum(WEIGHTS[q.target] for q in queue)) for p in queue]
        for queue in queues
    ]


def environment(place: Place, scratch: str) -> dict[str, str]:
    """Variables of a worker; raises TargetUnavailable where a file is missing that its driver needs.

    scratch  an empty folder for PoCL's compiled kernels
    """
    own = environment_of(driver(place.driver)) if place.driver else dict(os.environ)
    return {**own, **ONE_THREAD, REMARKS: "1", CACHE: scratch}


def _work(place: Place, options: Options, watch: Watch) -> dict[str, Any] | str:
    """What all visits to a driver found, or the reason why it is not available."""
    o = options
    job = Job(
        place.target,
        place.driver,
        o.functions,
        o.effort,
        o.uniform,
        o.family,
        o.figures,
        o.seconds,
        o.leave_out,
    )
    before = list(os.getloadavg())
    with compiled() as scratch:

        def visit(one: Job) -> dict[str, Any] | str:
            return _data("conformance.bench.worker", place, one.to_json(), watch, scratch)

        found = all_visits(job, o.visits, visit)
    if isinstance(found, str):
        return found
    return complete(found, {"before": before, "after": list(os.getloadavg())})


def compiled() -> tempfile.TemporaryDirectory[str]:
    """An empty folder for what a driver compiles: nothing is read that an earlier measurement left."""
    return tempfile.TemporaryDirectory(prefix="vair-")


def in_worker(module: str, place: Place, job: str, watch: Watch) -> dict[str, Any] | str:
    """The result of a job on a driver in a process of its own, or the reason why the driver is not available.

    module  what the process runs: it reads the job on standard input and says events, see worker.Channel
    errors  UserError where it fails
    """
    before = list(os.getloadavg())
    with compiled() as scratch:
        data = _data(module, place, job, watch, scratch)
    if isinstance(data, str):
        return data
    return complete(data, {"before": before, "after": list(os.getloadavg())})


def _data(module: str, place: Place, job: str, watch: Watch, scratch: str) -> dict[str, Any] | str:
    """What a worker answers, not yet completed."""
    try:
        variables = environment(place, scratch)
    except TargetUnavailable as reason:
        return str(reason)
    process = subprocess.Popen(
        [sys.executable, "-m", module],
        cwd=default_root().parent,
        env=variables,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdin is not None and process.stdout is not None
    with process:
        with suppress(BrokenPipeError):  # it has ended already: its status says how
            process.stdin.write(job)
            process.stdin.close()
        answer: dict[str, Any] | str | None = None
        for line in process.stdout:
            event = _event(line)
            if event.get("event") == "result":
                answer = event["data"]
            elif event.get("event") == "unavailable":
                answer = str(event["reason"])
            elif event:
                watch(place.label, event)
    if answer is None:
        status = process.returncode
        raise UserError(f"measuring on {place.label} failed with status {status}; see the messages above")
    return answer


def _event(line: str) -> dict[str, Any]:
    """The event on a line; empty for what a driver prints."""
    try:
        event = json.loads(line)
    except json.JSONDecodeError:
        return {}
    return event if isinstance(event, dict) else {}
