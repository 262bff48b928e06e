"""`python -m conformance.drivers.worker`: checks functions on one driver, in a process with its environment.

Reads one pickled Job from standard input; writes one pickled FunctionResult after the other to standard
output, each as soon as it is known, so that a driver that takes the process down costs one result.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, BinaryIO

from codegen.errors import UserError
from codegen.execute import execute
from codegen.kernels import kernel
from codegen.library import Library, load_library
from conformance.check.backend import Backend, told
from conformance.check.engine import check_function
from conformance.check.identity import Identity
from conformance.check.prepared import prepare
from conformance.check.replay import lane_of
from conformance.check.result import FunctionResult
from conformance.drivers.limits import limit_memory, limit_time
from conformance.drivers.modes import Mode, mode
from targets import BuildFailed, TargetUnavailable
from targets.drivers import Driver, driver, open_driver


@dataclass(frozen=True)
class Job:
    """What one process does: these functions, on this driver, in this mode.

    uniform, family  how many points; None: as many as the mode asks for
    replay           only this lane
    words            the lane's input, where a record brings it; drawn anew if empty
    cache            a folder in which processes share references and intervals
    """

    driver: str
    mode: str
    functions: tuple[str, ...]
    uniform: int | None = None
    family: int | None = None
    replay: Identity | None = None
    words: str = ""
    cache: Path | None = None


def driver_backend(chosen: Driver, how: Mode) -> Backend:
    """The backend of a driver in a mode, in a process with its environment; raises TargetUnavailable."""
    runtime = open_driver(chosen, **how.settings())
    options = how.kernel_options(chosen)

    def run(library: Library, name: str, inputs: Mapping[str, Any]) -> Any:
        return execute(library, name, inputs, runtime, options=options)

    def text(library: Library, name: str) -> str:
        # Literal arguments differ from program to program; the rest is the same.
        return kernel(library, name, chosen.target, replace(options, source="words"))

    return Backend(
        chosen.target,
        told(runtime.device),
        run,
        backend_name(chosen.name, how.name),
        how.table,
        text,
        runtime.device,
    )


def backend_name(driver_name: str, mode_name: str) -> str:
    """A driver and a mode in one word, as replay identities carry it: swiftshader+uniform."""
    return f"{driver_name}+{mode_name}"


def judge(library: Library, name: str, on: Backend, job: Job) -> FunctionResult:
    """Check one function; what stops it on the way is the result's stage and sentence."""
    try:
        function, again = library.function(name), job.replay
        if again is not None:
            points = [lane_of(function, again, job.words)]
        else:
            points = mode(job.mode).draws(function, job.uniform, job.family)
        return check_function(library, name, on, prepared=prepare(library, name, points, job.cache))
    except UserError as e:
        return _stopped(name, on, "emit", f"is not emitted: {e}")
    except BuildFailed as e:
        return _stopped(name, on, "compile", f"does not compile: {e.log}")
    except (RuntimeError, ValueError, MemoryError) as e:
        return _stopped(name, on, "execute", f"does not execute: {e}")


def _stopped(name: str, on: Backend, stage: str, sentence: str) -> FunctionResult:
    return FunctionResult(name, on.target, on.driver, backend=on.name, broken=sentence, stage=stage)


def main() -> None:
    """Run one job."""
    results = _private_output()
    job: Job = pickle.load(sys.stdin.buffer)
    library = load_library()
    try:
        on = driver_backend(driver(job.driver), mode(job.mode))
    except TargetUnavailable as reason:
        pickle.dump(str(reason), results)
        results.flush()
        return
    if not driver(job.driver).system:  # that of a GPU may reserve as much as it likes
        limit_memory()
    for name in job.functions:
        limit_time()
        pickle.dump(judge(library, name, on, job), results)
        results.flush()


def _private_output() -> BinaryIO:
    """Standard output for results alone: what a driver prints goes to standard error."""
    private = os.dup(1)
    os.dup2(2, 1)
    return os.fdopen(private, "wb")


if __name__ == "__main__":
    main()
