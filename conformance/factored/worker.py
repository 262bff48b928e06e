"""Times factored shades on one driver in a process of its own; see conformance.bench.worker."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from conformance.bench.timing import QUICK, Effort
from conformance.bench.worker import Say, opened_driver, serve
from conformance.factored.plan import library, read_plan
from conformance.factored.speed import measure

QUICK_SAMPLES = 20_000
"""Samples of the fits of a quick measurement."""


def job(target: str, driver: str, *, quick: bool) -> str:
    """What to measure where, as text."""
    return json.dumps({"target": target, "driver": driver, "quick": quick})


def answer(text: str, say: Say) -> dict[str, Any]:
    """The measurement of a job."""
    told = json.loads(text)
    runtime = opened_driver(told["target"], told["driver"])
    plan = read_plan()
    if told["quick"]:
        plan = replace(plan, samples=QUICK_SAMPLES)
    return measure(library(), runtime, plan, QUICK if told["quick"] else Effort(), say)


if __name__ == "__main__":
    serve(answer)
