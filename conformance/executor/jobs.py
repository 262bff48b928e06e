"""Jobs and results as pure data, and the one way in which every executor performs a job."""

from __future__ import annotations

import functools
import importlib
import os
from dataclasses import dataclass
from typing import Any

from targets import TARGETS, TargetUnavailable, probe

DEVICELESS = ("numpy",)
"""Targets that need no driver: the IR evaluated by numpy."""


@dataclass(frozen=True)
class Job:
    """One piece of work; the same job always gives the same result, wherever and however often it runs.

    task         "package.module:function", called with the job; returns plain data (JSON's types)
    target       whose driver it needs; several are joined by commas: whoever does the job has all of them
    start, stop  the range of the work, in the task's own unit; step: every how many
    options      further numbers and words of the task
    """

    task: str
    function: str
    target: str
    start: int = 0
    stop: int = 1
    step: int = 1
    seed: int = 0
    options: tuple[tuple[str, str], ...] = ()

    @property
    def targets(self) -> tuple[str, ...]:
        """The targets that it needs."""
        return tuple(self.target.split(","))

    @property
    def identity(self) -> str:
        """The job as one word."""
        parts = [self.task, self.function, self.target, self.start, self.stop, self.step, self.seed]
        return "/".join([*map(str, parts), *(f"{name}={value}" for name, value in self.options)])


@dataclass(frozen=True)
class Result:
    """What became of a job: its data, or the sentence that says why there are none."""

    job: Job
    data: dict[str, Any]
    error: str = ""

    @property
    def done(self) -> bool:
        return not self.error


@functools.cache
def available(target: str) -> str:
    """Empty if this machine can run the work of these targets; else the sentence that says why it cannot."""
    if "," in target:
        return "; ".join(filter(None, map(available, target.split(","))))
    if target in DEVICELESS:
        return ""
    if target not in TARGETS:
        return f"there is no target {target}"
    answer = probe(target)
    return str(answer) if isinstance(answer, TargetUnavailable) else ""


def perform(job: Job) -> Result:
    """Do a job in this process. What the task raises becomes the result's error: it would raise again."""
    module, _, name = job.task.partition(":")
    try:
        data: dict[str, Any] = getattr(importlib.import_module(module), name)(job)
    except Exception as e:
        return Result(job, {}, f"{type(e).__name__}: {e}")
    return Result(job, data)


def echo(job: Job) -> dict[str, Any]:
    """A task for tests of executors: who did it, and the sum of the range.

    Options: `fatal` names a file; while it is there, the process removes it and ends at once, as if killed.
    """
    options = dict(job.options)
    fatal = options.get("fatal", "")
    if fatal and os.path.exists(fatal):
        os.unlink(fatal)
        os._exit(9)
    if "raise" in options:
        raise ValueError(options["raise"])
    return {"sum": sum(range(job.start, job.stop, job.step)), "target": job.target}
