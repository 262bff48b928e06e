"""Integers between two ends: the narrowest interval that the exact results of an operation fill.

Plan. Intervals about the ends of the types, 0 and powers of two, for every operator: the ends are those of
the exact integers (Python's, which do not wrap), moved into the type where both wrap as often, else every
integer; lanes that are known are exact, whatever they wrap.
  causes            the first operand's before the second's
  words of floats   ascend with the magnitude; of bits beyond a number anything is made
  conversions       round where a float cannot hold the integer, truncate and tell what is beyond the type
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from codegen.intervals import load_table, logic, operations, whole
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import Context
from codegen.intervals.interpreter import reinterpreted
from codegen.intervals.values import Range, Whole

TURN = 2**32
Box = tuple[int, int]
WORDS: list[Box] = [
    (0, 0), (0, 3), (1, 1), (2, 5), (5, 40), (7, 2**16), (2**16, 2**16 + 9), (2**26 + 1, 2**27),
    (30, 31), (31, 32), (2**21, 2**21), (2**31 - 1, 2**31 + 1), (2**31, 2**31 + 1),
    (TURN - 4, TURN - 2), (TURN - 1, TURN - 1), (0, TURN - 1),
]  # fmt: skip
SIGNED: list[Box] = [
    (0, 0), (-3, 4), (-7, -2), (1, 1), (3, 9), (2**26 - 1, 2**26), (-(2**26) - 1, -(2**26) - 1),
    (2**16, 2**16 + 9), (-(2**21), -(2**21)), (2**30, 2**30 + 5),
    (2**31 - 3, 2**31 - 1), (-(2**31), -(2**31) + 1), (-(2**31), -(2**31)), (-(2**31), 2**31 - 1),
]  # fmt: skip
LARGEST_PRODUCT = 2**52
"""Products beyond it count as any integer."""


def into_type(low: int, high: int, is_signed: bool) -> Box:
    """The interval as the type wraps it; every integer where its ends wrap differently."""
    least = -(2**31) if is_signed else 0
    turns = (low - least) // TURN
    if turns != (high - least) // TURN:
        return least, least + TURN - 1
    return low - turns * TURN, high - turns * TURN


def exact(op: str, a: Box, b: Box) -> Box:
    """Ends of the results, without wrapping."""
    match op:
        case "+":
            return a[0] + b[0], a[1] + b[1]
        case "-":
            return a[0] - b[1], a[1] - b[0]
        case "*":
            corners = [x * y for x in a for y in b]
            lost = max(map(abs, corners)) > LARGEST_PRODUCT
            return (0, 2 * TURN) if lost else (min(corners), max(corners))
        case "//":  # by 0 it is the dividend, as if by 1
            return a[0] // max(b[1], 1), a[1] // max(b[0], 1)
        case ">>":
            # A shift by 32 is one by 0.
            return (a[0] >> b[1], a[1] >> b[0]) if b[1] <= 31 else (0, a[1])
        case "&":
            return 0, min(a[1], b[1])
        case "min" | "max":
            order = min if op == "min" else max
            return order(a[0], b[0]), order(a[1], b[1])
        case _:
            return 0, TURN - 1


KNOWN: dict[str, Any] = {
    "+": lambda x, y: x + y, "-": lambda x, y: x - y, "*": lambda x, y: x * y,
    "//": lambda x, y: x // max(y, 1), "%": lambda x, y: x % max(y, 1), "<<": lambda x, y: x << y % 32,
    ">>": lambda x, y: x >> y % 32, "&": lambda x, y: x & y, "|": lambda x, y: x | y, "^": lambda x, y: x ^ y,
    "min": min, "max": max,
}  # fmt: skip


def wholes(boxes: list[Box], is_signed: bool, cause: Any = None) -> Whole:
    low, high = (np.array([box[k] for box in boxes], np.int64) for k in (0, 1))
    return Whole(low, high, is_signed, cause)


def context(lanes: int, table: str = "wgsl") -> Context:
    return Context(load_table(table), CauseBook(), lanes)


def pairs(found: Whole | Range) -> list[Any]:
    return list(zip(found.low.tolist(), found.high.tolist(), strict=True))


def apply(op: str, a: Whole, b: Whole) -> Whole:
    here = context(len(a.low))
    by_name = op in ("min", "max")
    found = operations.scalar_builtin(here, op, a, b) if by_name else operations.binary(here, op, a, b)
    assert isinstance(found, Whole)
    return found


CASES = [(op, False) for op in KNOWN] + [(op, True) for op in ("+", "-", "*", "min", "max")]


@pytest.mark.parametrize(("op", "is_signed"), CASES)
def test_hull_of_an_operator(op: str, is_signed: bool) -> None:
    boxes = SIGNED if is_signed else WORDS
    lanes = list(itertools.product(boxes, boxes))
    found = apply(op, *(wholes([lane[k] for lane in lanes], is_signed) for k in (0, 1)))
    for (a, b), ends in zip(lanes, pairs(found), strict=True):
        if a[0] == a[1] and b[0] == b[1]:
            known = KNOWN[op](a[0], b[0])
            expected = into_type(known, known, is_signed)
        else:
            expected = into_type(*exact(op, a, b), is_signed)
            if op == "//" and b[0] < 1:
                expected = (expected[0], a[1])
        assert ends == expected, (a, b)
    assert found.is_signed == is_signed and found.cause is None and not found.is_point


@pytest.mark.parametrize(("op", "is_signed"), CASES)
def test_known_integers_stay_one_array(op: str, is_signed: bool) -> None:
    known = [box[0] for box in (SIGNED if is_signed else WORDS)]
    lanes = list(itertools.product(known, known))
    a, b = (np.array([lane[k] for lane in lanes], np.int64) for k in (0, 1))
    found = apply(op, Whole(a, a, is_signed), Whole(b, b, is_signed))
    assert found.is_point and found.is_signed == is_signed
    expected = [KNOWN[op](x, y) for x, y in lanes]
    assert found.low.tolist() == [into_type(x, x, is_signed)[0] for x in expected]
    half = apply(op, Whole(a, a, is_signed), Whole(b, b.copy(), is_signed))
    assert not half.is_point and half.low.tolist() == half.high.tolist() == found.low.tolist()


@pytest.mark.parametrize("op", KNOWN)
def test_causes_of_integers(op: str) -> None:
    """The first operand's before the second's, known or not; the type is the operands'."""
    known = np.array([9, 9, 9], np.int64)
    for high in (known, known + 1):
        first, second = np.array([5, 5, 0], np.int16), np.array([7, 0, 7], np.int16)
        found = apply(op, Whole(known, high, False, first), Whole(known, high, False, second))
        assert found.cause is not None and found.cause.tolist() == [5, 5, 7]
        assert not found.is_signed
        found = apply(op, Whole(known, high, False), Whole(known, high, False, second))
        assert found.cause is second


@pytest.mark.parametrize("is_signed", [False, True])
def test_negation_complement_and_reinterpretation(is_signed: bool) -> None:
    boxes = SIGNED if is_signed else WORDS
    codes = np.arange(len(boxes)).astype(np.int16)
    a = wholes(boxes, is_signed, codes)
    made = {"negate": [into_type(-high, -low, is_signed) for low, high in boxes]}
    if not is_signed:
        made["~"] = [(TURN - 1 - high, TURN - 1 - low) for low, high in boxes]
    for op, expected in made.items():
        found = operations.unary(context(len(boxes)), op, a)
        assert isinstance(found, Whole)
        assert pairs(found) == expected and found.cause is codes and found.is_signed == is_signed
        known = operations.unary(context(len(boxes)), op, Whole(a.low, a.low, is_signed, codes))
        assert isinstance(known, Whole) and known.is_point and known.cause is codes
    other = reinterpreted(a, not is_signed)
    least, most = other.limits
    fits = [least <= low and high <= most for low, high in boxes]
    assert pairs(other) == [box if fit else (least, most) for box, fit in zip(boxes, fits, strict=True)]
    assert other.cause is codes and other.is_signed != is_signed
    assert reinterpreted(a, is_signed) is a
    known = reinterpreted(Whole(a.low, a.low, is_signed, codes), not is_signed)
    assert known.is_point and known.cause is codes and known.is_signed != is_signed
    assert known.low.tolist() == [into_type(low, low, not is_signed)[0] for low, _ in boxes]


def test_clamp_of_integers() -> None:
    x, least, most = (
        wholes(boxes, True) for boxes in ([(-9, 9), (2, 3)], [(0, 1), (4, 5)], [(4, 6), (9, 9)])
    )
    found = operations.scalar_builtin(context(2), "clamp", x, least, most)
    assert isinstance(found, Whole) and found.is_signed
    assert pairs(found) == [(0, 6), (4, 5)]
    for told in ((None, 7, 9), (None, None, 9), (None, 7, None)):
        codes = [None if c is None else np.array([c, c], np.int16) for c in told]
        given = [Whole(w.low, w.high, True, c) for w, c in zip((x, least, most), codes, strict=True)]
        found = operations.scalar_builtin(context(2), "clamp", *given)
        assert isinstance(found, Whole) and found.cause is not None
        assert found.cause[0] == next(c for c in told if c)


def bits(x: float) -> int:
    return int(np.float32(x).view(np.uint32))


def test_words_of_floats() -> None:
    boxes = [
        (1.0, 2.5),
        (-2.0, -1.0),
        (1e-40, 1.0),
        (-1.0, 1.0),
        (0.0, 1.0),
        (-1.0, 0.0),
        (0.0, 0.0),
        (3.0, 3.0),
    ]
    every = (0, TURN - 1)
    expected = [
        (bits(low), bits(high)) if low > 0 else (bits(high), bits(low)) if high < 0 else every
        for low, high in boxes
    ]
    low, high = (np.array([box[k] for box in boxes]).astype(np.float32).astype(np.float64) for k in (0, 1))
    found = whole.float_to_bits(Range(low, high))
    assert pairs(found) == expected and found.cause is None
    codes = (np.arange(len(boxes)) % 2 * 3).astype(np.int16)
    found = whole.float_to_bits(Range(low, high, codes))
    assert pairs(found) == [every if code else box for box, code in zip(expected, codes, strict=True)]
    assert found.cause is codes
    known = np.array([1.0, -2.0, 3.5])
    assert whole.float_to_bits(Range(known, known)).is_point
    found = whole.float_to_bits(Range(known, known, np.array([0, 2, 0], np.int16)))
    assert pairs(found) == [(bits(1.0),) * 2, every, (bits(3.5),) * 2]


@pytest.mark.parametrize(("table", "low", "high"), [("wgsl", 2**24, 2**24 + 2), ("opencl", 2**24, 2**24)])
def test_conversion_of_large_integers_is_rounded(table: str, low: int, high: int) -> None:
    odd = 2**24 + 1  # between two floats, of which the even one is 2^24
    for sign in (1, -1):
        known = np.array([sign * odd, 5], np.int64)
        box = sorted((sign * low, sign * high))
        for other in (known, known.copy()):
            found = logic.to_float(context(2, table), Whole(known, other, True))
            assert pairs(found) == [tuple(box), (5.0, 5.0)]
            assert found.is_point == (other is known and table == "opencl")
    codes = np.array([0, 4], np.int16)
    found = logic.to_float(context(2, table), Whole(np.array([1, 2]), np.array([3, odd]), False, codes))
    assert pairs(found) == [(1.0, 3.0), (-np.inf, np.inf)]
    found = logic.to_float(context(2, table), Whole(np.array([1, -odd]), np.array([3, 2]), True))
    assert pairs(found) == [(1.0, 3.0), (-high, 2.0)]


def test_floats_of_words() -> None:
    """Of one sign and finite they lie between; an earlier cause is kept, and told once."""
    inf, nan = bits(np.inf), bits(np.nan)
    boxes = [
        (bits(1.0), bits(2.0)), (bits(-1.0), bits(-2.0)), (bits(1.0), inf), (inf, nan),
        (bits(2.0), bits(-2.0)), (bits(3.0), bits(3.0)), (bits(-1.0), bits(-np.inf)),
    ]  # fmt: skip
    anything = (-np.inf, np.inf)
    expected = [(1.0, 2.0), (-2.0, -1.0), anything, anything, anything, (3.0, 3.0), anything]
    here = context(len(boxes))
    with np.errstate(invalid="ignore"):
        found = logic.from_bits(here, wholes(boxes, False))
    assert pairs(found) == expected
    assert found.cause is not None and found.cause.tolist() == [0, 0, 1, 1, 1, 0, 1]
    codes = np.array([9, 0, 9, 0, 0, 0, 0], np.int16)
    with np.errstate(invalid="ignore"):
        found = logic.from_bits(here, wholes(boxes, False, codes))
    assert found.cause is not None and found.cause.tolist() == [9, 0, 9, 1, 1, 0, 1]
    here = context(1)
    with np.errstate(invalid="ignore"):
        found = logic.from_bits(here, wholes([(inf, nan)], False, np.array([9], np.int16)))
    assert here.book.causes == [] and found.cause is not None and found.cause.tolist() == [9]
    known = np.array([bits(1.5), bits(-2.0), 0], np.int64)
    found = logic.from_bits(context(3), Whole(known, known, False))
    assert found.is_point and found.low.tolist() == [1.5, -2.0, 0.0] and found.cause is None


def test_truncation_keeps_known_numbers_known() -> None:
    x = np.array([2.75, -2.75, 0.5])
    here = context(3)
    found = logic.to_integer(here, Range(x, x), True)
    assert logic.floor(here, Range(x, x)).is_point and here.forks == 2
    assert found.is_point and found.low.tolist() == [2, -2, 0] and found.low.dtype == np.int64
    same = logic.to_integer(context(3), Range(x, x + 0.125), True)
    assert same.is_point and same.low.tolist() == [2, -2, 0]
    wide = logic.to_integer(context(3), Range(x, x + 1.0), True)
    assert pairs(wide) == [(2, 3), (-2, -1), (0, 1)]
    for code in (None, np.array([0, 0, 6], np.int16)):
        floor = logic.floor(context(3), Range(x, x, code))
        assert floor.is_point and floor.low.tolist() == [2.0, -3.0, 0.0] and floor.cause is code
        floor = logic.floor(context(3), Range(x, x + 1.0, code))
        assert pairs(floor) == [(2.0, 3.0), (-3.0, -2.0), (0.0, 1.0)] and floor.cause is code


def test_truncation_of_what_is_beyond_the_type_tells_its_operand() -> None:
    here = context(3)
    x = np.array([3e9, 1.0, -3e9])
    for high in (x, x + 0.5):
        found = logic.to_integer(here, Range(x, high), True)
        assert found.cause is not None and found.cause.tolist() == [1, 0, 1]
        assert pairs(found) == [(-(2**31), 2**31 - 1), (1, 1), (-(2**31), 2**31 - 1)]
    (told,) = here.book.causes
    assert (told.operand, told.reason) == ("x", "outside the integers of the type")
    here = context(3)
    found = logic.to_integer(here, Range(x, x, np.array([7, 0, 8], np.int16)), True)
    assert found.cause is not None and found.cause.tolist() == [7, 0, 8] and here.book.causes == []
