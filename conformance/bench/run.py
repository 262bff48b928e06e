"""Measuring all targets: one worker process each, whose environment makes its driver use one thread."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from codegen.errors import UserError
from codegen.library import default_root
from conformance.bench.record import complete
from conformance.bench.timing import QUICK, Effort
from conformance.bench.worker import Job

ONE_THREAD = {"LP_NUM_THREADS": "1", "POCL_MAX_PTHREAD_COUNT": "1"}
FIRST = ("opencl", "wgsl", "glsl")
"""Order of starting: what takes longest comes first."""

Watch = Callable[[str, dict[str, Any]], None]
"""Called with a target and an event of its worker: started (total), done (what)."""


@dataclass(frozen=True)
class Options:
    """What to measure on every target; see worker.Job. `at_once`: workers side by side."""

    functions: tuple[str, ...] = ()
    effort: Effort = Effort()  # noqa: RUF009 - frozen
    uniform: int = 20_000
    family: int = 2_000
    figures: int = 20_000
    at_once: int = 2

    @staticmethod
    def quick(functions: tuple[str, ...] = ()) -> Options:
        """Fewer rounds and fewer inputs."""
        return Options(functions, QUICK, uniform=4_000, family=500, figures=4_000)


def measure(
    targets: Sequence[str], options: Options, watch: Watch = lambda target, event: None
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """Measure these targets.

    returns  the data of each that is here, as recorded files hold it; and why each of the others is not
    errors   UserError where a worker fails
    """
    order = sorted(targets, key=lambda t: FIRST.index(t) if t in FIRST else len(FIRST))
    with ThreadPoolExecutor(max(1, min(options.at_once, os.cpu_count() or 1))) as pool:
        running = {t: pool.submit(_work, t, options, watch) for t in order}
        answers = {t: running[t].result() for t in targets}
    found = [answer for answer in answers.values() if not isinstance(answer, str)]
    missing = {t: answer for t, answer in answers.items() if isinstance(answer, str)}
    return found, missing


def _work(target: str, options: Options, watch: Watch) -> dict[str, Any] | str:
    """One worker's result, or the reason why the target is not available."""
    o = options
    job = Job(target, o.functions, o.effort, o.uniform, o.family, o.figures)
    before = list(os.getloadavg())
    process = subprocess.Popen(
        [sys.executable, "-m", "conformance.bench.worker"],
        cwd=default_root().parent,
        env={**os.environ, **ONE_THREAD},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdin is not None and process.stdout is not None
    with process:
        process.stdin.write(job.to_json())
        process.stdin.close()
        answer: dict[str, Any] | str | None = None
        for line in process.stdout:
            event = _event(line)
            if event.get("event") == "result":
                answer = complete(event["data"], {"before": before, "after": list(os.getloadavg())})
            elif event.get("event") == "unavailable":
                answer = str(event["reason"])
            elif event:
                watch(target, event)
    if answer is None:
        raise UserError(f"measuring {target} failed with status {process.returncode}; see the messages above")
    return answer


def _event(line: str) -> dict[str, Any]:
    """The event on a line; empty for what a driver prints."""
    try:
        event = json.loads(line)
    except json.JSONDecodeError:
        return {}
    return event if isinstance(event, dict) else {}
