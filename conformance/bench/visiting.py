"""Visits to one driver, one after another, until the order of its functions is known or the time is up.

The first visit does all that needs doing once and times everything. The second times everything again, in
another process, minutes later. Further ones time what the others leave open.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from conformance.bench.joining import GroupTiming, timing
from conformance.bench.record import group_data, timing_data
from conformance.bench.steady import Rounds, steady
from conformance.bench.timing import Again
from conformance.bench.visits import to_visit
from conformance.bench.worker import Job

Key = tuple[str, str]
"""Base and mode."""
Visits = dict[Key, list[Rounds]]

SECOND = 0.25
"""Share of the time that the second visit gets at least."""


def all_visits(
    job: Job,
    most: int,
    visit: Callable[[Job], dict[str, Any] | str],
    clock: Callable[[], float] = time.monotonic,
) -> dict[str, Any] | str:
    """The data of a driver as its visits give it together.

    job     the first visit's, with the time for all of them (0: as long as it takes)
    most    visits
    visit   what a worker answers to a job: data, or the reason why the driver is not here
    """
    begin = clock()
    result = visit(replace(job, seconds=job.seconds * (1.0 - SECOND) if most > 1 else job.seconds))
    if isinstance(result, str):
        return result
    launches = {(g["base"], mode): data for g in result["groups"] for mode, data in g["modes"].items()}
    found: Visits = {key: [data["rounds_ns"]] for key, data in launches.items()}
    for turn in range(1, most):
        left = job.seconds - (clock() - begin)
        if turn == 1:
            left = max(left, SECOND * job.seconds)
        again = wanted(found, launches, turn)
        if not again or (job.seconds and left <= 0.0):
            break
        seconds = left if job.seconds else 0.0
        answer = visit(replace(job, seconds=seconds, again=again))
        if isinstance(answer, str):
            break
        for g in answer["groups"]:
            for mode, data in g["modes"].items():
                found[g["base"], mode].append(data["rounds_ns"])
    return together(result, launches, found)


def wanted(
    found: Mapping[Key, Sequence[Rounds]], launches: Mapping[Key, Mapping[str, Any]], turn: int
) -> dict[str, dict[str, Again]]:
    """What the visit of this number times: base -> mode -> members; always with the base itself."""
    again: dict[str, dict[str, Again]] = {}
    for (base, mode), visits in found.items():
        members = to_visit(steady(visits))
        if members:
            names = tuple(dict.fromkeys([base, *members]))
            launch = launches[base, mode]
            again.setdefault(base, {})[mode] = Again(names, launch["steps"], launch["lanes"], turn)
    return again


def together(
    result: Mapping[str, Any],
    launches: Mapping[Key, Mapping[str, Any]],
    found: Mapping[Key, Sequence[Rounds]],
) -> dict[str, Any]:
    """The first visit's data with the speeds and open pairs of all visits."""
    timings: dict[Key, GroupTiming] = {key: timing(visits, key[0]) for key, visits in found.items()}
    functions = []
    for entry in result["functions"]:
        speed = {
            mode: timing_data(t.members[entry["name"]])
            for (base, mode), t in timings.items()
            if base == entry["base"]
        }
        functions.append({**entry, "speed": speed})
    groups: dict[str, dict[str, Any]] = {}
    for (base, mode), t in timings.items():
        launch = launches[base, mode]
        groups.setdefault(base, {})[mode] = group_data(t, launch["steps"], launch["lanes"])
    as_list = [{"base": base, "modes": modes} for base, modes in groups.items()]
    return {**result, "functions": functions, "groups": as_list}
