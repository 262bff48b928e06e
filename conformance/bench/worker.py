"""Measures one driver in a process of its own: `python -m conformance.bench.worker`, started by run.py.

The job comes as JSON on standard input; events leave as JSON, one a line, on standard output. A process of
its own, because drivers read the number of their threads from the environment before they start.
"""

from __future__ import annotations

import json
import math
import os
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

from codegen.execute import execute
from codegen.library import Library
from codegen.readme import SPEED
from conformance import peers
from conformance.bench import kernels
from conformance.bench.accuracy import Error, errors
from conformance.bench.figures import device_figures
from conformance.bench.inputs import Group, groups
from conformance.bench.record import (
    described_device,
    error_data,
    function_data,
    method_data,
)
from conformance.bench.selfcheck import self_checks
from conformance.bench.timing import Again, Bench, Effort, GroupRounds
from conformance.bench.vectorised import STANDARD_OUTPUT
from conformance.bench.whole import whole
from conformance.check.engine import Backend
from targets import TargetUnavailable, TimedRuntime, open_runtime
from targets.drivers import driver, open_driver

Say = Callable[..., None]
CHECKED = "sin_angle"
"""The function that the self-checks time; the first measured one where the library lacks it."""


@dataclass(frozen=True)
class Job:
    """What to measure.

    target           glsl, wgsl or opencl
    driver           a driver of targets/drivers.toml by name; empty: the one that the target prefers
    functions        names; none: every function with variants
    uniform, family  inputs per function for its error: random ones, and at most of each hard family
    figures          random points per promised figure; 0: none
    seconds          how long it should take; 0: as long as it takes. Core functions come first
    leave_out        whether functions are left out that the time does not suffice for; else they get the
                     least number of rounds
    again            of a later visit: base -> mode -> what it times of the group, and nothing else is done
    """

    target: str
    driver: str
    functions: tuple[str, ...]
    effort: Effort
    uniform: int
    family: int
    figures: int
    seconds: float
    leave_out: bool = False
    again: dict[str, dict[str, Again]] = field(default_factory=dict)

    def to_json(self) -> str:
        """The job as text."""
        return json.dumps(asdict(self))

    @staticmethod
    def from_json(text: str) -> Job:
        """The job that to_json wrote."""
        data = json.loads(text)
        again = {
            base: {m: Again(**{**a, "members": tuple(a["members"])}) for m, a in modes.items()}
            for base, modes in data["again"].items()
        }
        effort = Effort(**data["effort"])
        return Job(**{**data, "functions": tuple(data["functions"]), "effort": effort, "again": again})


class Channel:
    """The events, as lines of JSON on what was standard output.

    Standard output itself becomes a file: drivers write to it, and some of that is of use (vectorised.py).
    """

    def __init__(self) -> None:
        self._stream = os.fdopen(os.dup(STANDARD_OUTPUT), "w", encoding="utf-8")
        self._file = tempfile.TemporaryFile()  # noqa: SIM115  open as long as the process
        os.dup2(self._file.fileno(), STANDARD_OUTPUT)

    def say(self, event: str, **content: Any) -> None:
        """One event."""
        self._stream.write(json.dumps({"event": event, **content}) + "\n")
        self._stream.flush()


def serve(answer: Callable[[str, Say], dict[str, Any]]) -> None:
    """Run the job on standard input.

    answer  (the job as JSON, what says an event) -> the result
    """
    channel = Channel()
    try:
        channel.say("result", data=answer(sys.stdin.read(), channel.say))
    except TargetUnavailable as e:
        channel.say("unavailable", reason=str(e))


def opened_driver(target: str, name: str) -> TimedRuntime:
    """The runtime of a driver by name, or of the one that the target prefers; raises TargetUnavailable."""
    return open_driver(driver(name)) if name else open_runtime(target)


def backend_of(runtime: TimedRuntime) -> Backend:
    """What computes results for their errors: the driver that is timed."""
    d = runtime.device

    def run(library: Library, name: str, inputs: Any) -> Any:
        return execute(library, name, inputs, runtime)

    return Backend(d.target, f"{d.api}; {d.driver}; {d.device}", run)


def measure(job: Job, say: Say) -> dict[str, Any]:
    """A first or a later visit to one driver, as data; says how far it is."""
    return later_visit(job, say) if job.again else first_visit(job, say)


def later_visit(job: Job, say: Say) -> dict[str, Any]:
    """The rounds of what is timed again; groups that the time does not suffice for are missing."""
    end = time.monotonic() + job.seconds if job.seconds else math.inf
    library = peers.library()
    bench = Bench(library, opened_driver(job.target, job.driver), job.effort)
    by_name = {mode.name: mode for mode in kernels.modes(job.target)}
    say("started", total=len(job.again), software=bench.software)
    kept = []
    for k, (base, wanted) in enumerate(job.again.items()):
        if time.monotonic() > end:
            break
        until = time.monotonic() + (end - time.monotonic()) / (len(job.again) - k)
        (group,) = groups(library, [base])
        found = {name: bench.group(group, by_name[name], until, a) for name, a in wanted.items()}
        kept.append(rounds_data(base, found))
        say("done", what=f"{base} again")
    return {"groups": kept}


def rounds_data(base: str, found: dict[str, GroupRounds]) -> dict[str, Any]:
    """The rounds of a group, by mode."""
    return {"base": base, "modes": {mode: vars(rounds) for mode, rounds in found.items()}}


def first_visit(job: Job, say: Say) -> dict[str, Any]:
    """Everything that is measured of one driver; of the times, the rounds of each group."""
    end = time.monotonic() + job.seconds if job.seconds else math.inf
    library = peers.library()
    chosen = sorted(groups(library, job.functions), key=lambda g: g.base.name not in SPEED)
    runtime = opened_driver(job.target, job.driver)
    bench = Bench(library, runtime, job.effort)
    on = backend_of(runtime)
    say("started", total=len(chosen) + 2, software=bench.software)
    checked = groups(library, [CHECKED])[0] if CHECKED in library.public else chosen[0]
    checks = self_checks(bench, checked)
    say("done", what="self-checks")
    functions: list[dict[str, Any]] = []
    kept: list[dict[str, Any]] = []
    left_out: list[str] = []
    for k, group in enumerate(chosen):
        if job.leave_out and time.monotonic() > end:
            left_out.append(group.base.name)
            continue
        # Every group gets an equal share of the time that is left.
        until = time.monotonic() + (end - time.monotonic()) / (len(chosen) - k)
        domain, found = errors(library, group, on, job.uniform, job.family)
        entries, timings = measured(library, bench, group, domain, found, until)
        everywhere = whole(library, group, on, job.uniform, job.family)
        for entry in entries:
            own = everywhere.get(entry["name"])
            entry["whole"] = vars(own) if own is not None else None
        functions += entries
        kept.append(timings)
        say("done", what=group.base.name)
    figures = [f.as_data() for f in device_figures(library, on, job.figures)] if job.figures else []
    say("done", what="figures")
    return {
        "device": {"driver_name": job.driver, **described_device(runtime.device)},
        "method": method_data(bench),
        "self_checks": {"function": checked.base.name, **checks},
        "functions": functions,
        "groups": kept,
        "left_out": left_out,
        "figures": figures,
    }


def measured(
    library: Library, bench: Bench, group: Group, domain: str, found: dict[str, Error], until: float
) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """The entries of a group, without their speed; and its rounds in every mode."""
    vectorised = bench.vectorised(group)
    modes = [m for m in kernels.modes(bench.runtime.device.target) if m.looped or bench.effort.flat]
    rounds = {}
    for k, mode in enumerate(modes):
        share = time.monotonic() + (until - time.monotonic()) / (len(modes) - k)
        rounds[mode.name] = bench.group(group, mode, share)
    entries = [
        {
            **function_data(library, f, group.base.name),
            "speed": {},  # follows from the rounds of all visits
            "vectorised": vars(vectorised[f.name]),
            "error": error_data(found[f.name], domain) if f.name in found else None,
        }
        for f in group.members
    ]
    return entries, rounds_data(group.base.name, rounds)


if __name__ == "__main__":
    serve(lambda text, say: measure(Job.from_json(text), say))
