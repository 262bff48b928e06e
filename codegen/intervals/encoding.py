"""Recorded steps as instructions of codegen.intervals.machine, where it has one that gives the same bits.

Each rule below is the case of codegen.intervals.bulk, codegen.intervals.arithmetic or codegen.intervals.logic
that the step took when it was recorded.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from codegen.intervals import bulk
from codegen.intervals.accuracy import Inherited, Ulp
from codegen.intervals.context import MOST_WAYS
from codegen.intervals.recording import Fact, Recorder, Step
from codegen.intervals.tables import Table
from codegen.intervals.values import Range, Truth


@dataclass(frozen=True)
class Instruction:
    """An operation of the machine on registers, which are floats or truth values in all lanes."""

    op: str
    results: tuple[int, ...]
    operands: tuple[int, ...]
    fork: int = 0
    parameters: tuple[float, ...] = ()


@dataclass
class Registers:
    """Registers of values by their numbers: of the ends of floats and of their products, of truth values.

    constants  register -> its number in all lanes
    truths     registers that hold truth values
    """

    recorder: Recorder
    of: dict[int, tuple[int, ...]] = field(default_factory=dict)
    products: dict[int, tuple[int, int]] = field(default_factory=dict)
    constants: dict[int, float | bool] = field(default_factory=dict)
    truths: set[int] = field(default_factory=set)
    count: int = 0
    _shared: dict[tuple[bool, float | bool], int] = field(default_factory=dict)

    def fresh(self, is_truth: bool = False) -> int:
        register = self.count
        self.count += 1
        if is_truth:
            self.truths.add(register)
        return register

    def ends(self, number: int) -> tuple[int, int]:
        """Both registers of a value: low and high, may hold and may fail."""
        if number not in self.of:
            self.define(number)
        low, high = self.of[number]
        return low, high

    def define(self, number: int) -> None:
        """Registers for a value; those of constants are shared."""
        known = self.recorder.facts[number]
        is_truth = known.kind is Truth
        value = known.constant
        if value is not None:
            sides = (value.true, value.false) if isinstance(value, Truth) else (value.low, value.high)
            low, high = (self.constant(side[0].item(), is_truth) for side in sides)
        else:
            low = self.fresh(is_truth)
            high = low if known.is_point else self.fresh(is_truth)
        self.of[number] = low, high
        if known.products and value is None:
            least = self.fresh()
            self.products[number] = least, least if known.products == 1 else self.fresh()

    def constant(self, value: float | bool, is_truth: bool) -> int:
        key = is_truth, value
        if key not in self._shared or value == 0.0:  # zeros of either sign are equal
            self._shared[key] = self.fresh(is_truth)
            self.constants[self._shared[key]] = value
        return self._shared[key]


@dataclass
class Encoder:
    """Instructions of steps under a table."""

    recorder: Recorder
    table: Table
    registers: Registers

    def encode(self, step: Step) -> list[Instruction] | None:
        """The instructions of a step; None where the machine has none."""
        facts = [self.recorder.facts[p] for p in step.parts]
        if step.op == "seen":
            return [Instruction("seen", (), self.registers.ends(step.parts[0]))]
        if step.op == "not":
            self.registers.of[step.results[0]] = self.registers.ends(step.parts[0])[::-1]
            return []
        if step.op in ("and", "or") and len(step.results) == 1:
            return [self.plain(step.op, step)]
        rule = _RULES.get(step.op)
        if rule is None or len(step.results) != 1:
            return None
        kinds = facts[1:] if step.op == "choose" else facts
        if any(f.kind is not Range for f in kinds) or any(f.constant and f.products for f in kinds):
            return None
        return rule(self, step, kinds, self.recorder.facts[step.results[0]])

    def plain(self, op: str, step: Step, *parameters: float) -> Instruction:
        """An instruction on both ends of all operands."""
        operands = [r for p in step.parts for r in self.registers.ends(p)]
        return Instruction(op, self.registers.ends(step.results[0]), tuple(operands), step.fork, parameters)

    def sides(self, op: str, step: Step) -> list[Instruction]:
        """Instructions on the lower ends and on the upper ones, which are the same for known numbers."""
        results = self.registers.ends(step.results[0])
        operands = [self.registers.ends(p) for p in step.parts]
        found = [Instruction(op, results[:1], tuple(low for low, _ in operands))]
        if results[1] != results[0]:
            found.append(Instruction(op, results[1:], tuple(high for _, high in operands)))
        return found


Found = list[Instruction] | None


def _all_points(facts: list[Fact]) -> bool:
    return all(f.is_point for f in facts)


def _add(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    if e.table.rounding == "either":
        return None if result.is_point else [e.plain("add", s)]
    a, b = s.parts
    return _add_nearest(e, a, b, s.results[0], facts, result)


def _add_nearest(e: Encoder, a: int, b: int, into: int, facts: list[Fact], result: Fact) -> Found:
    r = e.registers
    fused = [k for k, f in enumerate(facts) if f.products and e.table.fused]
    if result.is_point != (_all_points(facts) and not fused):
        return None
    if result.is_point:
        return [Instruction("add points", r.ends(into)[:1], (r.ends(a)[0], r.ends(b)[0]))]
    if not fused:
        return [Instruction("add nearest", r.ends(into), (*r.ends(a), *r.ends(b)))]
    of, other = (a, b) if fused[0] == 0 else (b, a)
    found = [Instruction("add fused", r.ends(into), (*r.ends(of), *r.ends(other), *r.products[of]))]
    if len(fused) > 1:
        found.append(Instruction("fuse", r.ends(into), (*r.ends(of), *r.products[other])))
    return found


def _subtract(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    a, b = s.parts
    if a == b:
        return None
    if e.table.rounding == "either":
        return None if result.is_point else [e.plain("subtract", s)]
    opposite = -1 - b  # the number of no other value
    e.recorder.facts[opposite] = Fact(Range, facts[1].is_point, facts[1].products)
    first = _negated(e, b, opposite)
    rest = _add_nearest(e, a, opposite, s.results[0], facts, result)
    return None if rest is None else first + rest


def _negate(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    return _negated(e, s.parts[0], s.results[0])


def _negated(e: Encoder, a: int, into: int) -> list[Instruction]:
    r = e.registers
    pairs = [(r.ends(into), r.ends(a))]
    if into in r.products:
        pairs.append((r.products[into], r.products[a]))
    found = []
    for (low, high), (a_low, a_high) in pairs:
        found.append(Instruction("negate", (low,), (a_high,)))
        if high != low:
            found.append(Instruction("negate", (high,), (a_low,)))
    return found


def _multiply(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    a, b = s.parts
    r = e.registers
    if e.table.rounding == "either":
        if result.is_point:
            return None
        if a != b:
            return [e.plain("multiply", s)]
        return [Instruction("square", r.ends(s.results[0]), r.ends(a))]
    if result.is_point != _all_points(facts) or not result.products:
        return None
    into = r.ends(s.results[0])
    kept = r.products[s.results[0]]
    if result.is_point:
        if result.products != 1:
            return None
        return [Instruction("multiply points", (kept[0], into[0]), (r.ends(a)[0], r.ends(b)[0]))]
    if a == b:
        return [Instruction("square nearest", (*kept, *into), r.ends(a))]
    return [Instruction("multiply nearest", (*kept, *into), (*r.ends(a), *r.ends(b)))]


def _divide(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    row = e.table.row("/")
    if "x" in row.magnitude or row.normal or result.is_point or not isinstance(row.accuracy, Ulp):
        return None
    return [e.plain("divide", s, row.accuracy.ulps, *bulk.limits(row, "y"))]


def _inverse_root(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    accuracy = e.table.row("inverse_sqrt").accuracy
    if result.is_point or not isinstance(accuracy, Ulp):
        return None
    return [e.plain("inverse_sqrt", s, accuracy.ulps)]


def _root(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    root, quotient = e.table.row("inverse_sqrt"), e.table.row("/")
    if result.is_point or not isinstance(e.table.row("sqrt").accuracy, Inherited):
        return None
    if "x" in quotient.magnitude or root.magnitude:
        return None
    assert isinstance(root.accuracy, Ulp) and isinstance(quotient.accuracy, Ulp)
    limits = bulk.limits(quotient, "y")
    return [e.plain("sqrt", s, root.accuracy.ulps, quotient.accuracy.ulps, *limits)]


def _ordered(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    op = "smaller" if s.op == "min" else "larger"
    return e.sides(op, s) if result.is_point == _all_points(facts) else None


def _clamp(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    return None if result.is_point or _all_points(facts) else [e.plain("clamp", s)]


def _absolute(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    return e.sides("size", s) if result.is_point else [e.plain("absolute", s)]


def _floor(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    if result.is_point:
        return e.sides("floor point", s)
    return [e.plain("floor", s, float(MOST_WAYS))]


def _compare(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    if s.parts[0] == s.parts[1]:
        return None
    op, is_opposite = {"<": ("<", False), "<=": ("<=", False), ">": ("<=", True), ">=": ("<", True)}.get(
        s.op, (s.op, False)
    )
    plain = e.plain(op, s)
    results = plain.results[::-1] if is_opposite else plain.results
    return [Instruction(op, results, plain.operands, s.fork)]


def _choose(e: Encoder, s: Step, facts: list[Fact], result: Fact) -> Found:
    condition, a, b = s.parts
    r = e.registers
    if result.is_point:
        operands = (*r.ends(condition), r.ends(a)[0], r.ends(b)[0])
        return (
            [Instruction("choose point", r.ends(s.results[0])[:1], operands)] if _all_points(facts) else None
        )
    return None if _all_points(facts) else [e.plain("choose", s)]


_RULES: dict[str, Callable[[Encoder, Step, list[Fact], Fact], Found]] = {
    "+": _add,
    "-": _subtract,
    "negate": _negate,
    "*": _multiply,
    "/": _divide,
    "inverse_sqrt": _inverse_root,
    "sqrt": _root,
    "min": _ordered,
    "max": _ordered,
    "clamp": _clamp,
    "abs": _absolute,
    "floor": _floor,
    "<": _compare,
    "<=": _compare,
    ">": _compare,
    ">=": _compare,
    "==": _compare,
    "choose": _choose,
}
