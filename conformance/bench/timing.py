"""Timing the variants of a function against each other on one runtime.

All kernels of a group run in turn, forwards and backwards (A B B A), in every round; a ratio is formed within
a round, and the median over the rounds counts. Software drivers are timed by the CPU time of the thread that
computes, see clocks.py; hardware by the clock on the wall.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

import numpy as np

from codegen.backends import complete_program
from codegen.execute import Words
from codegen.library import Library
from conformance.bench import kernels
from conformance.bench.clocks import SECONDS, Clock, driver_clock
from conformance.bench.inputs import Group, lanes
from conformance.bench.kernels import FLAT, THROUGHPUT, Mode
from conformance.bench.stopping import settled
from conformance.bench.vectorised import Vectorised, by_construction, from_remarks, remarks, tells
from conformance.bench.visits import BASELINE
from targets import Device, TimedRuntime
from targets.protocol import Prepared

SOFTWARE = (
    "llvmpipe",
    "lavapipe",
    "softpipe",
    "swiftshader",
    "portable computing language",
    "pthread",
    "rusticl",
    "warp",
)
"""Drivers that run on the CPU, by words in their names."""

SOFTWARE_LANES = 512
HARDWARE_LANES = 1 << 16
FLAT_LANES = 1 << 14
MOST_STEPS = 1 << 15
"""llvmpipe gives up on a loop after 65535 steps."""


def is_software(device: Device) -> bool:
    """Whether the device is a CPU."""
    text = f"{device.api} {device.driver} {device.device}".lower()
    return any(word in text for word in SOFTWARE)


@dataclass(frozen=True)
class Effort:
    """How much a measurement takes.

    rounds    least rounds, in each of which every kernel is launched twice
    most      most rounds; they go on until the order of every two members is known, see stopping.py
    seconds   least time of one launch of the base's kernel
    launches  least time of one launch as a multiple of what an empty launch takes
    flat      whether kernels without a loop are timed as well, where that makes a difference
    """

    rounds: int = 16
    most: int = 48
    seconds: float = 2.5e-3
    launches: float = 12.0
    flat: bool = True


VISIT = Effort(rounds=12, most=24)
"""One of several visits."""
QUICK = Effort(rounds=8, most=12, seconds=1e-3, launches=6.0, flat=False)


@dataclass(frozen=True)
class GroupRounds:
    """One visit to a group in one mode.

    rounds_ns     per kernel (the baseline's name is empty) the nanoseconds per evaluation of every round
    steps, lanes  of each launch
    """

    rounds_ns: dict[str, list[float]]
    steps: int
    lanes: int


@dataclass(frozen=True)
class Again:
    """What a later visit times of a group in one mode.

    members       names, the base among them
    steps, lanes  as in the first visit
    turn          number of the visit: every other one prepares the kernels in opposite order, so that others
                  lie beside each other in memory
    """

    members: tuple[str, ...]
    steps: int
    lanes: int
    turn: int


class Bench:
    """Measures on one runtime."""

    def __init__(self, library: Library, runtime: TimedRuntime, effort: Effort) -> None:
        self.library = library
        self.runtime = runtime
        self.effort = effort
        self.software = is_software(runtime.device)
        self.lanes = SOFTWARE_LANES if self.software else HARDWARE_LANES
        self.clock: Clock = time.perf_counter
        self.clock_name = "wall"
        if self.software:
            self.clock, self.clock_name = self.find_clock()
        self.empty = self.empty_launch()
        self.seconds = max(effort.seconds, effort.launches * self.empty)

    def find_clock(self) -> tuple[Clock, str]:
        """The clock of a software driver, found by a launch that takes long."""
        group = Group(next(iter(self.library.public.values())), ())
        words, steps, taken = self.words(group, THROUGHPUT), 1, 0.0
        text = kernels.kernel(self.library, group.base.name, self.runtime.device.target, THROUGHPUT)
        while taken < SECONDS and steps < MOST_STEPS:
            steps *= 4
            with self.prepared({"": text}, words, steps) as ready:
                ready[""].launch()
                # Not by the wall: where other programs compute too, a short launch takes long as well.
                begin = time.process_time()
                ready[""].launch()
                taken = time.process_time() - begin
        with self.prepared({"": text}, words, steps) as ready:
            ready[""].launch()
            return driver_clock(ready[""].launch)

    def empty_launch(self) -> float:
        """Seconds that a kernel takes which does next to nothing."""
        text = complete_program(self.runtime.device.target, "", "    store_u32(0, load_u32(0));")
        one = self.runtime.prepare(text, np.zeros((1, self.lanes), np.uint32), 1)
        times = [self.launch(one) for _ in range(9)]
        one.release()
        return float(np.median(times))

    def group(
        self,
        group: Group,
        mode: Mode,
        until: float = math.inf,
        again: Again | None = None,
    ) -> GroupRounds:
        """One visit to a group in one mode.

        until  time of time.monotonic() after which only the least number of rounds is run
        again  what a later visit times; None: all members, for as many steps and lanes as it takes
        """
        target = self.runtime.device.target
        names = [f.name for f in group.members if again is None or f.name in again.members]
        texts = {name: kernels.kernel(self.library, name, target, mode) for name in names}
        texts[BASELINE] = kernels.baseline(self.library, group.base.name, target, mode)
        words = self.words(group, mode)
        if again is not None:
            words, steps = words[:, : again.lanes], again.steps
            texts = dict(reversed(texts.items())) if again.turn % 2 else texts
        else:
            if mode == FLAT:
                words = self.enough_lanes(texts[group.base.name], words)
            steps = self.steps(texts[group.base.name], words, mode)
        with self.prepared(texts, words, steps) as ready:
            rounds = self.rounds(ready, lambda so_far: settled(so_far, BASELINE), until)
        scale = 1e9 / (2 * words.shape[1] * mode.evaluations * steps)
        order = [*names, BASELINE]
        return GroupRounds({name: [t * scale for t in rounds[name]] for name in order}, steps, words.shape[1])

    def vectorised(self, group: Group) -> dict[str, Vectorised]:
        """Per member, on how many work items its kernel computes at once; without a loop where it matters."""
        device = self.runtime.device
        if not tells(device) or not self.effort.flat:
            return {f.name: by_construction(device) for f in group.members}
        found = {}
        for f in group.members:
            found[f.name] = from_remarks(remarks(partial(self.compile_flat, group, f.name)))
        return found

    def compile_flat(self, group: Group, name: str) -> None:
        """Build a member's kernel without a loop; PoCL compiles it at its first launch."""
        text = kernels.kernel(self.library, name, self.runtime.device.target, FLAT)
        with self.prepared({name: text}, self.words(group, FLAT), 1) as ready:
            ready[name].launch()

    def words(self, group: Group, mode: Mode) -> Words:
        """Inputs for every lane of a kernel."""
        count = max(self.lanes, FLAT_LANES) if mode == FLAT else self.lanes
        distinct = lanes(self.library, group, min(count, SOFTWARE_LANES))
        return np.tile(distinct, (1, count // distinct.shape[1]))

    def enough_lanes(self, text: str, words: Words) -> Words:
        """So many of the lanes that one launch without a loop lasts about as long as it should."""
        few = words[:, :SOFTWARE_LANES]
        with self.prepared({"": text}, few, 1) as ready:
            ready[""].launch()  # the first one compiles
            taken = min(self.launch(ready[""]) for _ in range(3)) - self.empty
        times = int(np.ceil(self.seconds / max(taken, 1e-9)))
        return words[:, : SOFTWARE_LANES * max(times, 1)]

    def steps(self, text: str, words: Words, mode: Mode) -> int:
        """Steps that make one launch last about as long as it should."""
        steps = 1
        while mode.looped and steps < MOST_STEPS:
            with self.prepared({"": text}, words, steps) as ready:
                ready[""].launch()  # the first one compiles
                taken = min(self.launch(ready[""]) for _ in range(2)) - self.empty
            if taken >= 0.7 * self.seconds:
                break
            steps = min(steps * int(np.clip(self.seconds / max(taken, 1e-9), 2, 8)), MOST_STEPS)
        return steps

    @contextmanager
    def prepared(self, texts: Mapping[str, str], words: Words, steps: int) -> Iterator[dict[str, Prepared]]:
        """The kernels, ready to launch."""
        given = kernels.words(words, steps)
        ready: dict[str, Prepared] = {}
        try:
            for name, text in texts.items():
                ready[name] = self.runtime.prepare(text, given, 1)
            yield ready
        finally:
            for one in ready.values():
                one.release()

    def launch(self, one: Prepared) -> float:
        """Seconds of one launch."""
        begin = self.clock()
        one.launch()
        return self.clock() - begin

    def rounds(
        self,
        ready: Mapping[str, Prepared],
        enough: Callable[[Mapping[str, list[float]]], bool] = lambda so_far: True,
        until: float = math.inf,
    ) -> dict[str, list[float]]:
        """Per kernel the seconds of its two launches in each round.

        enough  whether the rounds so far tell what is asked; asked after the least number of them
        """
        times: dict[str, list[float]] = {name: [] for name in ready}
        for one in ready.values():
            for _ in range(2):
                one.launch()
        order = list(ready)
        for done in range(max(self.effort.most, self.effort.rounds)):
            if done >= self.effort.rounds and (time.monotonic() > until or enough(times)):
                break
            sums = dict.fromkeys(order, 0.0)
            for name in (*order, *reversed(order)):
                sums[name] += self.launch(ready[name])
            for name, total in sums.items():
                times[name].append(total)
            order.append(order.pop(0))  # no kernel always follows the same one
        return times
