"""What an evaluation of intervals did, written down so that it can be done again with other lanes.

An evaluation over other lanes does the same operations on the same values, except where it depends on all
lanes together: whether a condition is decided for all of them, whether values are known exactly, how often a
loop runs. Such facts are written down beside the operations: where they differ, nothing may be repeated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from codegen.intervals.values import Range, Single, Truth, Value, Whole, choose


@dataclass(frozen=True)
class Fact:
    """What is known of a value for all lanes; `constant` is the value itself where all lanes share it."""

    kind: type
    is_point: bool = False
    products: int = 0
    constant: Single | None = None

    def holds(self, value: Single) -> bool:
        """Whether another value may take its place."""
        return self == fact(value)


def fact(value: Single) -> Fact:
    """What is to be known of a value."""
    if isinstance(value, Truth):
        return Fact(Truth, constant=value if len(value.true) == 1 else None)
    constant = value if len(value.low) == 1 else None
    if isinstance(value, Whole):
        return Fact(Whole, value.is_point, constant=constant)
    product = value.product
    products = 0 if product is None else 1 if product[0] is product[1] else 2
    return Fact(Range, value.is_point, products, constant)


@dataclass(frozen=True)
class Step:
    """One operation: its name, the numbers of its operands and results, how to do it, its first fork."""

    op: str
    parts: tuple[int, ...]
    results: tuple[int, ...]
    apply: Callable[[Any, Any], Any] | None
    fork: int


@dataclass
class Recorder:
    """Steps in their order, and what is known of values, by their numbers.

    seen    condition -> 1 where it may hold in a lane, plus 2 where it may fail in one
    failed  whether the evaluation cannot be repeated
    """

    inputs: list[int] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    facts: dict[int, Fact] = field(default_factory=dict)
    seen: dict[int, int] = field(default_factory=dict)
    failed: bool = False

    def give_up(self) -> None:
        """Something depends on the lanes in a way that is not written down."""
        self.failed = True

    def input(self, value: Single) -> None:
        """A value that the evaluation begins with."""
        self.inputs.append(value.number)
        self.define(value)

    def define(self, value: Single) -> None:
        if not isinstance(value, Truth) and value.cause is not None:
            self.give_up()
        self.facts[value.number] = fact(value)

    def knows(self, value: Single) -> bool:
        """Whether a value is written down, or is a constant and thereby is."""
        if value.number not in self.facts:
            found = fact(value)
            if found.constant is None or (not isinstance(value, Truth) and value.cause is not None):
                return False
            self.facts[value.number] = found
        return True

    def operation(
        self, op: str, apply: Any, parts: tuple[Single, ...], found: Single | tuple[Single, ...], fork: int
    ) -> None:
        """An operation on some values gave another value, or several."""
        results = found if isinstance(found, tuple) else (found,)
        if self.failed or all(self.knows(r) for r in results):
            return
        if not all([self.knows(p) for p in parts]):
            self.give_up()
            return
        for value in results:
            self.define(value)
        numbers = tuple(p.number for p in parts)
        self.steps.append(Step(op, numbers, tuple(r.number for r in results), apply, fork))

    def choice(self, condition: Truth, a: Value, b: Value, found: Value) -> None:
        """A condition chose between two values."""
        if self.failed or len(condition.true) == 1:
            return
        if condition.number not in self.facts:
            self.give_up()
            return
        if condition.number not in self.seen:
            may, may_not = bool(condition.true.any()), bool(condition.false.any())
            self.seen[condition.number] = may + 2 * may_not
            self.steps.append(Step("seen", (condition.number,), (), None, 0))
        self._hull(condition, a, b, found)

    def _hull(self, condition: Truth, a: Value, b: Value, found: Value) -> None:
        if found is a or found is b:
            return
        if isinstance(a, dict) and isinstance(b, dict) and isinstance(found, dict):
            for name, value in a.items():
                self._hull(condition, value, b[name], found[name])
        elif isinstance(a, tuple) and isinstance(b, tuple) and isinstance(found, tuple):
            for x, y, z in zip(a, b, found, strict=True):
                self._hull(condition, x, y, z)
        elif isinstance(a, Single) and isinstance(b, Single) and isinstance(found, Single):
            self.operation("choose", _chosen, (condition, a, b), found, 0)


def _chosen(context: Any, parts: Any) -> Value:
    return choose(*parts)
