"""Running drivers by name, each in processes of its own, and putting their results together."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codegen.errors import UserError
from conformance.check.identity import Identity
from conformance.check.result import FunctionResult
from conformance.drivers.limits import CPU_SECONDS
from conformance.drivers.modes import Mode
from conformance.drivers.worker import Job, backend_name
from targets import Device, TargetUnavailable
from targets.drivers import Driver, environment_of, strings

ROOT = Path(__file__).parents[2]
OUTSIDE = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
"""Signals that someone sends to a process; a driver that fails gets another one."""
MODULE = "conformance.drivers.worker"
_RUNNING: set[subprocess.Popen[bytes]] = set()

Report = Callable[[FunctionResult], None]


@dataclass(frozen=True)
class DriverRun:
    """The results of one driver in one mode."""

    driver: Driver
    device: Device
    mode: Mode
    results: tuple[FunctionResult, ...]

    @property
    def full_name(self) -> str:
        """Name and version of the driver, as lists of known failures speak of it."""
        return f"{self.driver.name} {self.driver.version_of(self.device)}".strip()


def run_driver(
    chosen: Driver,
    device: Device,
    how: Mode,
    functions: Sequence[str],
    told: Report = lambda result: None,
    *,
    uniform: int | None = None,
    family: int | None = None,
    replay: Identity | None = None,
    words: str = "",
    cache: Path | None = None,
) -> DriverRun:
    """Check functions on a driver in a mode.

    device   what the driver answered when it was probed
    told     called with every result as it comes
    uniform, family  how many points; None: as many as the mode asks for
    replay   only this lane
    words    the lane's input, where a record brings it
    cache    a folder in which processes share references and intervals
    raises   TargetUnavailable where the driver does not open; UserError where someone ended its process

    Where the process ends before a function's result, that function failed to execute, and a new process
    goes on with the rest.
    """
    results: list[FunctionResult] = []
    left = list(functions)
    while left:
        job = Job(chosen.name, how.name, tuple(left), uniform, family, replay, words, cache)
        found, status, last = _process(chosen, job, told)
        if -status in OUTSIDE:
            raise UserError(f"the process of {chosen.name} was ended from outside, by signal {-status}")
        results += found
        left = left[len(found) :]
        if left:
            lost = FunctionResult(
                left.pop(0),
                chosen.target,
                "; ".join(strings(device)),
                backend=backend_name(chosen.name, how.name),
                stage="execute",
                broken=f"does not execute: {_end_of(status, last)}",
            )
            told(lost)
            results.append(lost)
    return DriverRun(chosen, device, how, tuple(results))


def end_all() -> None:
    """End the processes that run: a driver deep in its own code hears no interrupt."""
    for process in _RUNNING.copy():
        process.terminate()


def _end_of(status: int, last: str) -> str:
    """How a driver's process ended, in words; `last` is the last line that it said."""
    if -status == signal.SIGXCPU:
        return f"the driver took more than {CPU_SECONDS} s of processor time"
    return f"the driver's process ended with status {status} {last}".rstrip()


def _process(chosen: Driver, job: Job, told: Report) -> tuple[list[FunctionResult], int, str]:
    """The results of one process, its exit status, and the last line that it said."""
    found: list[FunctionResult] = []
    with tempfile.TemporaryFile() as noise:
        process = subprocess.Popen(
            [sys.executable, "-m", MODULE],
            env=environment_of(chosen),
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=noise,
        )
        _RUNNING.add(process)
        try:
            with process:
                assert process.stdin is not None and process.stdout is not None
                with suppress(BrokenPipeError):  # it has ended already: its status says how
                    process.stdin.write(pickle.dumps(job))
                    process.stdin.close()
                for answer in _answers(process.stdout):
                    if isinstance(answer, str):
                        raise TargetUnavailable(answer)
                    told(answer)
                    found.append(answer)
        finally:
            _RUNNING.discard(process)
        noise.seek(0)
        last = noise.read().decode(errors="replace").strip().splitlines()[-1:]
    return found, process.returncode, " ".join(last)


def _answers(pipe: Any) -> Iterable[Any]:
    while True:
        try:
            yield pickle.load(pipe)
        except (EOFError, pickle.UnpicklingError):
            return
