"""Frames drawn in turns, forwards and backwards, and what the rounds say.

The clock of a software driver is the processor time of the process: vertices, set-up and fragments are
computed by different threads, and other programs change it little. Hardware is timed by the wall clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from conformance.bench.clocks import Clock
from conformance.bench.fur.frames import Frame
from conformance.bench.ratios import Spread, spread
from conformance.bench.timing import is_software
from targets import Device

Rounds = dict[str, list[float]]
THREADS = {"LP_NUM_THREADS": "1"}
"""Environment in which software drivers compute on one thread: processor time is then what a frame costs."""


def frame_clock(device: Device) -> tuple[Clock, str]:
    """What frames are timed by, and its name."""
    if is_software(device):
        return time.process_time, "processor time of the process, driver on one thread"
    return time.perf_counter, "wall"


def drawn_in_turns(frames: Mapping[str, Frame], target: str, rounds: int, clock: Clock) -> Rounds:
    """Seconds of every drawing, two per round: A B B A."""
    scenes = {name: frame.open(target) for name, frame in frames.items()}
    try:
        works = {name: partial(scenes[name].render, frame.block) for name, frame in frames.items()}
        return in_turns(works, rounds, clock)
    finally:
        for scene in scenes.values():
            scene.release()


def in_turns(works: Mapping[str, Callable[[], None]], rounds: int, clock: Clock) -> Rounds:
    """Seconds of every run, by work: in each round forwards and backwards. The first runs do not count."""
    for work in works.values():
        work()
    times: Rounds = {name: [] for name in works}
    order = list(works)
    for _ in range(rounds):
        for name in (*order, *reversed(order)):
            begin = clock()
            works[name]()
            times[name].append(clock() - begin)
        order.append(order.pop(0))
    return times


def ratio(times: Sequence[float], reference: Sequence[float]) -> Spread:
    """Time over time, formed within each pass over the frames."""
    return spread([a / b for a, b in zip(times, reference, strict=True)])


def net_of(times: Sequence[float], reference: Sequence[float], floor: Sequence[float]) -> Spread:
    """The same above what a frame without lighting takes."""
    pairs = zip(times, reference, floor, strict=True)
    return spread([(a - c) / max(b - c, 1e-9) for a, b, c in pairs])


def summary(rounds: Rounds) -> dict[str, Any]:
    """Milliseconds per frame with quartiles, by frame."""
    return {name: as_data(spread([1000.0 * t for t in times])) for name, times in rounds.items()}


def as_data(s: Spread) -> dict[str, Any]:
    """Median and quartiles."""
    return {"median": s.median, "quartiles": [s.low, s.high]}


def line(x: Sequence[float], y: Sequence[float]) -> dict[str, float]:
    """The straight line through points by least squares.

    returns  slope, intercept, and `residual`: the largest distance of a point from the line as a share of the
             largest y
    """
    xs, ys = np.asarray(x, np.float64), np.asarray(y, np.float64)
    slope, intercept = np.polyfit(xs, ys, 1)
    off = np.abs(ys - (slope * xs + intercept)).max() / np.abs(ys).max()
    return {"slope": float(slope), "intercept": float(intercept), "residual": float(off)}
