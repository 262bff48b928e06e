"""What one evaluation carries along: its table, where it is, why values are unbounded, which way lanes go.

A comparison that a lane's intervals do not decide, or a rounding to an integer that may give several, is a
fork. The lane is followed with the hull of all ways and notes its first fork; codegen.intervals.permit may
then follow each way on its own, with the operands narrowed to it.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field

import numpy as np

from codegen.intervals.causes import Cause, CauseBook, Codes, mark
from codegen.intervals.compiled import wanted
from codegen.intervals.memory import Memory
from codegen.intervals.numbers import Array
from codegen.intervals.tables import Table
from codegen.intervals.values import Single
from codegen.ir.nodes import Const

MOST_WAYS = 24
"""A fork with more ways than this is followed by its hull only."""


@dataclass
class Ways:
    """The ways that lanes were told to take: fork and way per lane and depth, (lanes, depth); -1: none."""

    forks: Array
    ways: Array

    def at(self, fork: int) -> Array | None:
        """The way of each lane at a fork, -1 where it is free; None where all are."""
        taken: Array | None = None
        for forks, ways in zip(self.forks.T, self.ways.T, strict=True):
            hit = forks == fork
            if hit.any():
                told = np.where(hit, ways, np.int32(-1))
                taken = told if taken is None else np.maximum(taken, told)
        return taken

    def then(self, index: Array, fork: Array, way: Array) -> Ways:
        """These lanes, taking one way more."""
        return Ways(np.column_stack([self.forks[index], fork]), np.column_stack([self.ways[index], way]))


@dataclass
class Context:
    """State of one evaluation over some lanes.

    constants, literals  literals by their value, and by the identity of their node
    loops   whether operations run as compiled loops, see codegen.intervals.bulk
    memory  results by what they were computed from
    """

    table: Table
    book: CauseBook
    lanes: int
    ways: Ways | None = None
    function: str = ""
    line: int = 0
    operation: str = ""
    forks: int = 0
    constants: dict[Hashable, Single] = field(default_factory=dict)
    literals: dict[int, tuple[Const, Single]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.loops = self.table.flush and wanted(self.lanes)
        # A way narrows values that others were computed from: there the first result has to be kept.
        self.memory = Memory(forgets=self.ways is None)
        self.first_fork = np.full(self.lanes, -1, np.int32)
        self.width = np.zeros(self.lanes, np.int32)

    def unbounded(self, codes: Codes, where: Array, operand: str, reason: str) -> Codes:
        """The causes, with this operation's where the mask is set."""
        if not where.any():
            return codes
        cause = Cause(self.function, self.line, self.operation, operand, reason)
        return mark(codes, where, self.book.code(cause))

    def decided(self) -> None:
        """A fork that no lane has, or that was met before: forks have the same numbers for all lanes."""
        self.forks += 1

    def fork(self, widths: Array) -> Array | None:
        """A fork with so many ways per lane, (N,) or (1,), 1: none. Gives the way each lane takes; -1: all.

        None where no lane was told a way.
        """
        number = self.forks
        self.forks += 1
        taken = None if self.ways is None else self.ways.at(number)
        open_ = (widths > 1) & (widths <= MOST_WAYS)
        if taken is not None:
            open_ = open_ & (taken < 0)
        if open_.any():
            noted = open_ & (self.first_fork < 0)
            self.first_fork = np.where(noted, number, self.first_fork)
            self.width = np.where(noted, widths, self.width)
        return taken
