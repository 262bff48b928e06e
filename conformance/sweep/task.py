"""One piece of a sweep: a range of places of one function, on one target or on several at once.

Several targets get the same numbers, so that the reference is computed once for all of them.
"""

from __future__ import annotations

from typing import Any

from codegen.library import load_library
from conformance.check.engine import Backend, backend
from conformance.executor import Job
from conformance.sweep.judge import Block, Judge, reference_of
from conformance.sweep.positions import positions
from conformance.sweep.source import source_of

TASK = "conformance.sweep.task:run"
TOGETHER = "conformance.sweep.task:run_together"
CHUNK = 1 << 20
"""Numbers per launch."""
BLOCK = 1 << 14
"""Numbers judged at a time: what numpy works on stays in the processor's cache."""

_backends: dict[str, Backend] = {}


def opened(target: str) -> Backend:
    """The target's backend, opened once per process."""
    if target not in _backends:
        _backends[target] = backend(target)
    return _backends[target]


def run(job: Job) -> dict[str, Any]:
    """What the range gives on one target: how many numbers and infinities, per bound the largest error."""
    (data,) = run_together(job).values()
    return dict(data)


def run_together(job: Job) -> dict[str, Any]:
    """What `run` says, for each target of the job."""
    library = load_library()
    function = library.function(job.function)
    where = positions(function)
    if where is None:
        raise ValueError(f"{job.function} is not a function of one number")
    reference, parameter = reference_of(library, function), function.parameters[0].name
    on = {target: opened(target) for target in job.targets}
    judges = {target: Judge(library, function, target) for target in on}
    stop = min(job.stop, where.count)
    for start in range(job.start, stop, CHUNK * job.step):
        x = where.values(start, min(start + CHUNK * job.step, stop), job.step)
        got = {target: b.run(library, job.function, {parameter: x}) for target, b in on.items()}
        for k in range(0, len(x), BLOCK):
            block = Block(reference, parameter, x[k : k + BLOCK])
            for target, judge in judges.items():
                judge.see(block, got[target][k : k + BLOCK])
    return {
        target: {
            "driver": b.driver,
            "source": source_of(library, job.function, target),
            **judges[target].data(),
        }
        for target, b in on.items()
    }
