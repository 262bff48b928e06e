"""Measures one target in a process of its own: `python -m conformance.bench.worker`, started by run.py.

The job comes as JSON on standard input; events leave as JSON, one a line, on standard output. A process of
its own, because drivers read the number of their threads from the environment before they start.
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, dataclass
from typing import Any

from codegen.library import Library, load_library
from conformance.bench import kernels
from conformance.bench.accuracy import Error, errors
from conformance.bench.figures import device_figures
from conformance.bench.inputs import Group, groups
from conformance.bench.record import described_device, error_data, function_data, method_data, timing_data
from conformance.bench.selfcheck import self_checks
from conformance.bench.timing import Bench, Effort
from conformance.check.engine import backend
from targets import TargetUnavailable, open_runtime

CHECKED = "sin_angle"
"""The function that the self-checks time; the first measured one where the library lacks it."""


@dataclass(frozen=True)
class Job:
    """What to measure.

    functions        names; none: every function with variants
    uniform, family  inputs per function for its error: random ones, and at most of each hard family
    figures          random points per promised figure; 0: none
    """

    target: str
    functions: tuple[str, ...]
    effort: Effort
    uniform: int
    family: int
    figures: int

    def to_json(self) -> str:
        """The job as text."""
        return json.dumps(asdict(self))

    @staticmethod
    def from_json(text: str) -> Job:
        """The job that to_json wrote."""
        data = json.loads(text)
        return Job(
            **{**data, "functions": tuple(data["functions"]), "effort": Effort(**data["effort"])},
        )


def say(event: str, **content: Any) -> None:
    """One event as a line of JSON."""
    print(json.dumps({"event": event, **content}), flush=True)


def measure(job: Job) -> dict[str, Any]:
    """The whole measurement of one target, as data; says how far it is."""
    library = load_library()
    chosen = groups(library, job.functions)
    runtime = open_runtime(job.target)
    bench = Bench(library, runtime, job.effort)
    on = backend(job.target)
    say("started", total=len(chosen) + 2, software=bench.software)
    checked = groups(library, [CHECKED])[0] if CHECKED in library.public else chosen[0]
    checks = self_checks(bench, checked)
    say("done", what="self-checks")
    functions: list[dict[str, Any]] = []
    for group in chosen:
        domain, found = errors(library, group, on, job.uniform, job.family)
        functions += measured(library, bench, group, domain, found)
        say("done", what=group.base.name)
    figures = [f.as_data() for f in device_figures(library, on, job.figures)] if job.figures else []
    say("done", what="figures")
    return {
        "device": described_device(runtime.device),
        "method": method_data(bench),
        "self_checks": {"function": checked.base.name, **checks},
        "functions": functions,
        "figures": figures,
    }


def measured(
    library: Library, bench: Bench, group: Group, domain: str, found: dict[str, Error]
) -> list[dict[str, Any]]:
    """The entries of a group: speed in every mode beside the error."""
    speeds = {mode.name: bench.group(group, mode) for mode in kernels.modes(bench.runtime.device.target)}
    return [
        {
            **function_data(library, f, group.base.name),
            "speed": {mode: timing_data(timings[f.name]) for mode, timings in speeds.items()},
            "error": error_data(found[f.name], domain) if f.name in found else None,
        }
        for f in group.members
    ]


def main() -> None:
    """Run the job on standard input."""
    job = Job.from_json(sys.stdin.read())
    try:
        say("result", data=measure(job))
    except TargetUnavailable as e:
        say("unavailable", reason=str(e))


if __name__ == "__main__":
    main()
