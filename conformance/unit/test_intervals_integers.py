"""Whole numbers hold every result of an operation and, between points, only that.

Plan. Intervals between the ends of the types, 0 and numbers about them; results are enumerated at places of
each. Where nothing wraps, intervals stay as narrow as they can be.
"""

from __future__ import annotations

import operator
from collections.abc import Callable

import numpy as np
import pytest

from codegen.intervals import load_table, operations
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.values import Whole


def context(lanes: int) -> Context:
    return Context(load_table("wgsl"), CauseBook(), lanes)


WORDS = (0, 1, 2, 5, 31, 32, 33, 2**31 - 1, 2**31, 2**32 - 2, 2**32 - 1)
SIGNED = (-(2**31), -(2**31) + 1, -3, -1, 0, 1, 4, 2**31 - 1)
OPERATORS: dict[str, Callable[[int, int], int]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "//": lambda a, b: a // max(b, 1),
    "%": lambda a, b: a % max(b, 1),
    "<<": lambda a, b: a << (b % 32),
    ">>": lambda a, b: a >> (b % 32),
    "&": operator.and_,
    "|": operator.or_,
    "^": operator.xor,
    "min": min,
    "max": max,
}


def wrap(value: int, is_signed: bool) -> int:
    return (value + 2**31) % 2**32 - 2**31 if is_signed else value % 2**32


def wholes(boxes: list[tuple[int, int]], is_signed: bool) -> Whole:
    low, high = (np.array([box[k] for box in boxes], np.int64) for k in (0, 1))
    return Whole(low, high, is_signed)


def apply_whole(op: str, a: Whole, b: Whole, lanes: int) -> Whole:
    here = context(lanes)
    made = (
        operations.scalar_builtin(here, op, a, b)
        if op in ("min", "max")
        else operations.binary(here, op, a, b)
    )
    assert isinstance(made, Whole)
    return made


OVERLOADS = [(op, False) for op in OPERATORS] + [(op, True) for op in ("+", "-", "*", "min", "max")]


@pytest.mark.parametrize(("op", "is_signed"), OVERLOADS)
def test_integers_hold_every_result(op: str, is_signed: bool) -> None:
    ends = SIGNED if is_signed else WORDS
    boxes = [(x, y) for x in ends for y in ends if x <= y]
    pairs = [(p, q) for p in boxes[::2] for q in boxes[1::2]] + [(p, q) for p in boxes[1::3] for q in boxes]
    if op in ("//", "%"):
        pairs = [(p, q) for p, q in pairs if q[0] > 0]
    a, b = (wholes([p[k] for p in pairs], is_signed) for k in (0, 1))
    found = apply_whole(op, a, b, len(pairs))
    assert found.is_signed == is_signed
    least, most = found.limits
    assert (found.low >= least).all() and (found.high <= most).all() and (found.low <= found.high).all()
    for lane, (p, q) in enumerate(pairs):
        places = [
            sorted({e for e in (x[0], x[0] + 1, (x[0] + x[1]) // 2, x[1]) if e <= x[1]}) for x in (p, q)
        ]
        results = [wrap(OPERATORS[op](x, y), is_signed) for x in places[0] for y in places[1]]
        assert found.low[lane] <= min(results) and max(results) <= found.high[lane], (op, p, q)
        if p[0] == p[1] and q[0] == q[1]:
            assert found.low[lane] == found.high[lane], (op, p, q)


TIGHT = {
    "+": ((2, 5), (10, 20), (12, 25)),
    "-": ((30, 50), (10, 20), (10, 40)),
    "*": ((2, 5), (10, 20), (20, 100)),
    "//": ((20, 50), (2, 5), (4, 25)),
    ">>": ((16, 64), (1, 3), (2, 32)),
    "&": ((16, 64), (1, 3), (0, 3)),
    "min": ((2, 15), (10, 20), (2, 15)),
    "max": ((2, 15), (10, 20), (10, 20)),
}


@pytest.mark.parametrize("op", TIGHT)
def test_integers_that_do_not_wrap_stay_narrow(op: str) -> None:
    p, q, expected = TIGHT[op]
    a, b = (wholes([x], False) for x in (p, q))
    found = apply_whole(op, a, b, 1)
    assert (found.low[0], found.high[0]) == expected


def test_signs_and_complements_of_integers() -> None:
    for is_signed in (True, False):
        ends = SIGNED if is_signed else WORDS
        boxes = [(x, y) for x in ends for y in ends if x <= y]
        a = wholes(boxes, is_signed)
        made = {"~": operator.invert} if not is_signed else {"negate": operator.neg}
        for op, apply in made.items():
            found = operations.unary(context(len(boxes)), op, a)
            assert isinstance(found, Whole)
            for lane, (low, high) in enumerate(boxes):
                results = [wrap(apply(x), is_signed) for x in {low, (low + high) // 2, high}]
                assert found.low[lane] <= min(results) and max(results) <= found.high[lane]
                assert low != high or found.low[lane] == found.high[lane]
