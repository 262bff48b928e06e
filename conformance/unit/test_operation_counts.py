"""The cost classes of the op registry count what the operations really do.

Plan.
  classes  every row has the class of its kind of operation, written here a second time
  work     rows made of several operations are evaluated on numbers that count what is done to them
Not covered here: what operations cost on a device (conformance/bench).
"""

from __future__ import annotations

from collections import Counter
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from codegen.ops import BUILTINS, OPERATORS, Op

CLASSES = {
    "free": "negate and or not abs float_to_bits bits_to_float texture_size",
    "add": "+ - < <= > >= == != << >> & | ^ ~ min max clamp floor",
    "multiply": "* dot cross",
    "divide": "/ // %",
    "root": "sqrt inverse_sqrt length normalize",
    "exponential": "exp exp2 log log2",
    "trigonometric": "sin cos atan2",
    "texture": "lookup lookup_level",
}
ROWS = {**OPERATORS, **BUILTINS}
SIZES = (2, 3, 4)


def test_every_operation_is_of_its_class() -> None:
    expected = {name: cost for cost, names in CLASSES.items() for name in names.split()}
    assert {name: row.cost for name, row in ROWS.items()} == {name: expected[name] for name in ROWS}


class Counting:
    """A number that only counts."""

    def __init__(self, counts: Counter[str]) -> None:
        self.counts = counts

    def done(self, cost: str) -> Counting:
        self.counts[cost] += 1
        return self

    def __add__(self, other: Any) -> Counting:
        return self.done("add")

    def __sub__(self, other: Any) -> Counting:
        return self.done("add")

    def __mul__(self, other: Any) -> Counting:
        return self.done("multiply")

    def __truediv__(self, other: Any) -> Counting:
        return self.done("divide")

    def sqrt(self) -> Counting:
        return self.done("root")


def counted(row: Op, size: int) -> dict[str, int]:
    """What evaluating a row on vectors of this size does."""
    counts: Counter[str] = Counter()
    operand = np.array([[Counting(counts) for _ in range(size)]], dtype=object)
    namespace = SimpleNamespace(sqrt=np.sqrt, divide=np.divide, stack=np.stack)
    row.meaning(namespace, *([operand] * len(row.names)))
    return dict(counts)


COMPOSED = [
    (row, size)
    for row in ROWS.values()
    if row.work is not None
    for size in SIZES
    if any(getattr(types[0], "size", 0) == size for types, _ in row.rule)
]


@pytest.mark.parametrize(("row", "size"), COMPOSED, ids=lambda v: getattr(v, "name", v))
def test_composed_operations_count_their_parts(row: Op, size: int) -> None:
    assert dict(row.operations(size)) == counted(row, size)


def test_other_operations_are_done_once_for_each_component() -> None:
    assert {row.name for row, _ in COMPOSED} == {"dot", "cross", "length", "normalize"}
    plain = [row for row in ROWS.values() if row.work is None]
    assert all(row.operations(size) == {row.cost: size} for row in plain for size in (1, *SIZES))
