"""A recorded evaluation, done again over other lanes: mostly by the machine, the rest operation by operation.

It gives the bits of codegen.intervals.interpreter, or nothing: where a fact differs from what was recorded,
or a lane needs a closer look, the interpreter has to do it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from codegen.intervals.context import Context
from codegen.intervals.encoding import Encoder, Instruction, Registers
from codegen.intervals.numbers import Array
from codegen.intervals.opcodes import FLOATS, OPCODES, WIDTH
from codegen.intervals.recording import Fact, Recorder, Step
from codegen.intervals.tables import Table
from codegen.intervals.values import Range, Single, Truth, Whole


@dataclass
class Lanes:
    """Where the registers of one evaluation are: a row each, of floats or of truth values."""

    floats: Array
    truths: Array


@dataclass(frozen=True)
class Segment:
    """Instructions that the machine runs without a stop."""

    code: Array
    parameters: Array


class Program:
    """Segments and steps in their order, over rows for so many lanes at most."""

    def __init__(self, recorder: Recorder, table: Table, results: list[Single], lanes: int) -> None:
        self.facts = recorder.facts
        self.inputs = recorder.inputs
        self.results = [r.number for r in results if recorder.knows(r)]
        self.complete = len(self.results) == len(results)
        self.lanes = lanes
        self.registers = Registers(recorder)
        for number in self.inputs:
            self._hold(number)
        self.expected: list[int] = []
        items = list(self._items(recorder, Encoder(recorder, table, self.registers)))
        for number in self.results:
            self._hold(number)
        self.rows = self._allocate(items)
        self.parts = list(self._segments(items))
        self._free: deque[Lanes] = deque()

    def _hold(self, number: int) -> None:
        if self.facts[number].kind is not Whole:
            self.registers.ends(number)

    def _items(self, recorder: Recorder, encoder: Encoder) -> Iterator[Instruction | Step]:
        for step in recorder.steps:
            found = encoder.encode(step)
            if found is None:
                for number in (*step.parts, *step.results):
                    self._hold(number)
                yield step
                continue
            for instruction in found:
                if instruction.op == "seen":
                    fork = len(self.expected)
                    self.expected.append(recorder.seen[step.parts[0]])
                    instruction = Instruction("seen", (), instruction.operands, fork)
                yield instruction

    def _registers(self, number: int) -> tuple[int, ...]:
        """All registers of a value; none of an integer, nor of a constant."""
        known = self.facts[number]
        if known.kind is Whole or known.constant is not None:
            return ()
        return (*self.registers.ends(number), *self.registers.products.get(number, ()))

    def _allocate(self, items: list[Instruction | Step]) -> dict[int, int]:
        """Register -> row: a row is used again once nothing needs what it holds."""
        last: dict[int, int] = {}
        uses = [self._uses(item) for item in items]
        for k, (_, used) in enumerate(uses):
            last.update(dict.fromkeys(used, k))
        kept = {r for number in (*self.inputs, *self.results) for r in self._registers(number)}
        kept |= set(self.registers.constants)
        rows: dict[int, int] = {}
        free: dict[bool, list[int]] = {False: [], True: []}
        self.counts = {False: 0, True: 0}

        def place(register: int) -> None:
            if register not in rows:
                kind = register in self.registers.truths
                if free[kind]:
                    rows[register] = free[kind].pop()
                else:
                    rows[register] = self.counts[kind]
                    self.counts[kind] += 1

        for register in sorted(kept):
            place(register)
        for k, (made, used) in enumerate(uses):
            for register in made:
                place(register)
            for register in {*made, *used}:
                if last.get(register, k) == k and register not in kept:
                    free[register in self.registers.truths].append(rows[register])
        return rows

    def _uses(self, item: Instruction | Step) -> tuple[list[int], list[int]]:
        if isinstance(item, Instruction):
            return list(item.results), [*item.operands, *item.results]
        made = [r for number in item.results for r in self._registers(number)]
        return made, made + [r for number in item.parts for r in self._registers(number)]

    def _segments(self, items: list[Instruction | Step]) -> Iterator[Segment | Step]:
        waiting: list[Instruction] = []
        for item in items:
            if isinstance(item, Instruction):
                waiting.append(item)
                continue
            if waiting:
                yield self._segment(waiting)
                waiting = []
            yield item
        if waiting:
            yield self._segment(waiting)

    def _segment(self, instructions: list[Instruction]) -> Segment:
        code = np.zeros((len(instructions), WIDTH), np.int64)
        parameters = np.zeros((len(instructions), FLOATS))
        for k, i in enumerate(instructions):
            row = [OPCODES[i.op], 0, i.fork, *(self.rows[r] for r in (*i.results, *i.operands))]
            code[k, : len(row)] = row
            parameters[k, : len(i.parameters)] = i.parameters
        return Segment(code, parameters)

    def _taken(self) -> Lanes:
        """Rows that nobody uses, the constants in theirs."""
        try:
            return self._free.pop()
        except IndexError:
            rows = Lanes(
                np.zeros((self.counts[False], self.lanes)),
                np.zeros((self.counts[True], self.lanes), np.bool_),
            )
            for register, value in self.registers.constants.items():
                of = rows.truths if register in self.registers.truths else rows.floats
                of[self.rows[register]] = value
            return rows

    def run(self, context: Context, inputs: list[Single]) -> list[Single] | None:
        """The results; None where the interpreter has to find them."""
        rows = self._taken()
        found = _Run(self, context, rows).run(inputs)
        self._free.append(rows)
        return found


class _Run:
    """One evaluation over some lanes."""

    def __init__(self, program: Program, context: Context, rows: Lanes) -> None:
        self.program, self.context, self.rows = program, context, rows
        self.wholes: dict[int, Single] = {}
        self.seen = np.zeros(len(program.expected) + 1, np.int64)
        self.expected = np.array(program.expected, np.int64)

    def run(self, inputs: list[Single]) -> list[Single] | None:
        for number, value in zip(self.program.inputs, inputs, strict=True):
            if not self.store(number, value):
                return None
        for part in self.program.parts:
            if not (self.machine(part) if isinstance(part, Segment) else self.step(part)):
                return None
        if (self.seen[:-1] != self.expected).any():
            return None
        return [_copied(self.load(number)) for number in self.program.results]

    def machine(self, segment: Segment) -> bool:
        from codegen.intervals import machine

        c = self.context
        c.width = c.width.astype(np.int32, copy=False)
        c.first_fork = c.first_fork.astype(np.int32, copy=False)
        rows = self.rows
        look = machine.run(
            segment.code,
            segment.parameters,
            rows.floats,
            rows.truths,
            c.first_fork,
            c.width,
            self.seen,
            c.lanes,
        )
        return not look and not (self.seen[:-1] & ~self.expected).any()

    def step(self, step: Step) -> bool:
        """An operation that the machine does not have."""
        assert step.apply is not None
        self.context.forks = step.fork
        loaded = {number: self.load(number) for number in step.parts}
        found = step.apply(self.context, tuple(loaded[number] for number in step.parts))
        results = found if isinstance(found, tuple) else (found,)
        return all([self.store(n, r) for n, r in zip(step.results, results, strict=True)])

    def load(self, number: int) -> Single:
        """A value as operations take it."""
        known = self.program.facts[number]
        if known.constant is not None:
            return known.constant
        if known.kind is Whole:
            return self.wholes[number]
        low, high = self.views(number, known, self.program.registers.ends(number))
        if known.kind is Truth:
            return Truth(low, high)
        product = None
        if known.products:
            product = self.views(number, known, self.program.registers.products[number])
        return Range(low, high, None, product)

    def views(self, number: int, known: Fact, registers: tuple[int, int]) -> tuple[Array, Array]:
        of = self.rows.truths if known.kind is Truth else self.rows.floats
        low = of[self.program.rows[registers[0]], : self.context.lanes]
        if registers[1] == registers[0]:
            return low, low
        return low, of[self.program.rows[registers[1]], : self.context.lanes]

    def store(self, number: int, value: Single) -> bool:
        """Keep a result; not where it differs in kind from what was recorded."""
        known = self.program.facts[number]
        if not isinstance(value, Truth) and value.cause is not None:
            return False
        if known.constant is not None:
            return True
        if not known.holds(value):
            return False
        if isinstance(value, Whole):
            self.wholes[number] = value
            return True
        ends = (value.true, value.false) if isinstance(value, Truth) else (value.low, value.high)
        pairs = [(self.program.registers.ends(number), ends)]
        if isinstance(value, Range) and value.product is not None:
            pairs.append((self.program.registers.products[number], value.product))
        for registers, arrays in pairs:
            for view, array in zip(self.views(number, known, registers), arrays, strict=True):
                np.copyto(view, array)
        return True


def _copied(value: Single) -> Single:
    """A result that does not lie in the rows any more."""
    if isinstance(value, Truth):
        return Truth(value.true.copy(), value.false.copy())
    if isinstance(value, Range):
        low = value.low.copy()
        return Range(low, low if value.is_point else value.high.copy())
    return value
