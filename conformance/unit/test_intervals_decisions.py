"""Comparisons, choices and roundings to integers, over every small interval.

Plan. All intervals on a grid with a few steps, each pair of them a lane; few lanes and many, which may be
computed in another way. Against what is enumerated here:
  truth     a comparison may hold where it holds for some pair of numbers, and fail where it does for some
  ways      of an undecided comparison, both operands keep exactly what the way leaves of them; a lane that is
            told no way, that may be anything, or that is decided keeps all; the fork is noted once
  integers  floor and conversions give every integer that they may, one where a way is told, and x keeps what
            gives it; whole numbers hold every result and, between points, only that
  choices   the hull of the sides that may be chosen, with the causes of those sides
"""

from __future__ import annotations

import itertools
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from codegen.intervals import compiled, load_table, logic, operations
from codegen.intervals.causes import CauseBook
from codegen.intervals.context import MOST_WAYS, Context, Ways
from codegen.intervals.values import Range, Truth, Whole, choose, constant

Array = Any
STEPS = 4
BOXES = [(a, b) for a in range(STEPS) for b in range(a, STEPS)]
PAIRS = list(itertools.product(BOXES, BOXES))
COPIES = (1, 12)
"""How often all lanes are repeated: few and many."""
COMPARISONS: dict[str, Callable[[Any, Any], Any]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
KINDS = {"floats": False, "integers": True}


def context(lanes: int, ways: Array | None = None) -> Context:
    """An evaluation; lanes may be told the way they take at the first fork, -1 for none."""
    told = None if ways is None else Ways(np.zeros((lanes, 1), np.int64), ways[:, None].astype(np.int32))
    return Context(load_table("wgsl"), CauseBook(), lanes, told)


def column(values: Any, copies: int, kind: type = np.float64) -> Array:
    return np.tile(np.array(values, kind), copies)


def operand(boxes: list[tuple[int, int]], copies: int, whole: bool, cause: Array | None = None) -> Any:
    low, high = (column([box[k] for box in boxes], copies, np.int64 if whole else np.float64) for k in (0, 1))
    return Whole(low, high, True, cause) if whole else Range(low, high, cause)


def numbers(box: tuple[int, int], whole: bool) -> Array:
    """Of integers all; of floats the ends and enough between them to order two intervals in every way."""
    return np.arange(box[0], box[1] + 1) if whole else np.linspace(box[0], box[1], 8 * (box[1] - box[0]) + 1)


def pairs_of(op: str, whole: bool) -> tuple[list[bool], list[bool]]:
    """Whether a comparison holds, and fails, for some numbers of each pair of intervals."""
    found = [COMPARISONS[op](numbers(a, whole)[:, None], numbers(b, whole)) for a, b in PAIRS]
    return [bool(f.any()) for f in found], [bool((~f).any()) for f in found]


@pytest.mark.parametrize("copies", COPIES)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("op", COMPARISONS)
def test_truth_of_a_comparison(op: str, kind: str, copies: int) -> None:
    lanes = len(PAIRS) * copies
    here = context(lanes)
    a, b = (operand([p[k] for p in PAIRS], copies, KINDS[kind]) for k in (0, 1))
    found = operations.binary(here, op, a, b)
    assert isinstance(found, Truth)
    true, false = (column(x, copies, np.bool_) for x in pairs_of(op, KINDS[kind]))
    np.testing.assert_array_equal(np.broadcast_to(found.true, lanes), true)
    np.testing.assert_array_equal(np.broadcast_to(found.false, lanes), false)
    undecided = true & false
    assert here.forks == 1
    np.testing.assert_array_equal(here.first_fork, np.where(undecided, 0, -1))
    np.testing.assert_array_equal(here.width, np.where(undecided, 2, 0))
    np.testing.assert_array_equal(a.low, column([p[0][0] for p in PAIRS], copies))


@pytest.mark.parametrize("copies", (1, 40))
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("op", COMPARISONS)
def test_decided_comparison_counts_as_a_fork_that_no_lane_has(op: str, kind: str, copies: int) -> None:
    """Forks have the same number however many lanes are evaluated, and in whatever way."""
    true, false = pairs_of(op, KINDS[kind])
    decided = [k for k, both in enumerate(zip(true, false, strict=True)) if not all(both)]
    here = context(len(decided) * copies)
    a, b = (operand([PAIRS[k][e] for k in decided], copies, KINDS[kind]) for e in (0, 1))
    found = operations.binary(here, op, a, b)
    assert isinstance(found, Truth)
    np.testing.assert_array_equal(found.true, column([true[k] for k in decided], copies, np.bool_))
    assert here.forks == 1
    assert (here.first_fork == -1).all()


@pytest.mark.parametrize("copies", COPIES)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("op", COMPARISONS)
def test_way_of_a_comparison_narrows_both_operands(op: str, kind: str, copies: int) -> None:
    whole, lanes = KINDS[kind], len(PAIRS) * copies
    weak = {"<": "<=", ">": ">=", "!=": ""}
    opposite = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "=="}
    true, false = (column(x, copies, np.bool_) for x in pairs_of(op, whole))
    ways = np.arange(lanes) // len(PAIRS) % 3 - 1 if copies > 2 else np.arange(lanes) % 3 - 1
    told = true & false & (ways >= 0)
    here = context(lanes, ways)
    a, b = (operand([p[k] for p in PAIRS], copies, whole) for k in (0, 1))
    found = operations.binary(here, op, a, b)
    assert isinstance(found, Truth)
    np.testing.assert_array_equal(np.broadcast_to(found.true, lanes), true & ~(told & (ways == 0)))
    np.testing.assert_array_equal(np.broadcast_to(found.false, lanes), false & ~(told & (ways == 1)))
    np.testing.assert_array_equal(here.first_fork, np.where(true & false & (ways < 0), 0, -1))
    for lane in range(lanes):
        box_a, box_b = PAIRS[lane % len(PAIRS)]
        kept_a, kept_b = numbers(box_a, whole), numbers(box_b, whole)
        holding = op if ways[lane] == 1 else opposite[op]
        holding = weak.get(holding, holding)  # intervals are closed: their ends stay
        if told[lane] and holding:
            keeps = COMPARISONS[holding](kept_a[:, None], kept_b)
            kept_a, kept_b = kept_a[keeps.any(axis=1)], kept_b[keeps.any(axis=0)]
        for x, kept in ((a, kept_a), (b, kept_b)):
            assert (x.low[lane], x.high[lane]) == (kept.min(), kept.max()), (op, box_a, box_b, ways[lane])


@pytest.mark.parametrize("op", COMPARISONS)
def test_a_value_compared_with_itself(op: str) -> None:
    here = context(len(BOXES))
    x = operand(BOXES, 1, False)
    found = operations.binary(here, op, x, x)
    assert isinstance(found, Truth)
    if op in ("<", ">", "!="):
        assert not found.true.any()
    if op in ("<=", ">="):
        assert found.true.all()
    points = np.array([a == b for a, b in BOXES])
    holds = COMPARISONS[op](1, 1)
    assert (found.true | ~points | (not holds)).all()
    assert (found.false | ~points | holds).all()


@pytest.mark.parametrize("copies", COPIES)
@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("op", COMPARISONS)
def test_what_may_be_anything_tells_nothing_and_forks_nothing(op: str, which: int, copies: int) -> None:
    lanes = len(PAIRS) * copies
    cause = (np.arange(lanes) % 2).astype(np.int16)
    codes = [cause if k == which else None for k in (0, 1)]
    for ways in (None, np.ones(lanes, np.int64)):
        here = context(lanes, ways)
        a, b = (operand([p[k] for p in PAIRS], copies, False, codes[k]) for k in (0, 1))
        found = operations.binary(here, op, a, b)
        assert isinstance(found, Truth)
        true, false = (column(x, copies, np.bool_) for x in pairs_of(op, False))
        free = cause > 0
        assert (found.true[free] & found.false[free]).all()
        np.testing.assert_array_equal(found.true[~free], true[~free])
        if ways is None:
            np.testing.assert_array_equal(found.false[~free], false[~free])
            np.testing.assert_array_equal(here.first_fork, np.where(true & false & ~free, 0, -1))
        for x, boxes in ((a, [p[0] for p in PAIRS]), (b, [p[1] for p in PAIRS])):
            np.testing.assert_array_equal(x.low[free], column([box[0] for box in boxes], copies)[free])
            np.testing.assert_array_equal(x.high[free], column([box[1] for box in boxes], copies)[free])


@pytest.mark.parametrize("whole", [False, True])
def test_what_may_be_anything_is_not_decided_by_its_ends(
    whole: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor where all lanes would be, in however many of them."""
    monkeypatch.setattr(compiled, "FEWEST", 2)
    cause = np.array([1, 0], np.int16)
    for op, holds in (("<", True), ("<=", True), ("==", False), ("!=", True), (">", False), (">=", False)):
        for codes in ((cause, None), (None, cause)):
            a, b = (
                operand([box] * 2, 1, whole, code) for box, code in zip([(0, 1), (2, 3)], codes, strict=True)
            )
            found = operations.binary(context(2), op, a, b)
            assert isinstance(found, Truth)
            assert found.true.tolist() == [True, holds] and found.false.tolist() == [True, not holds]


QUARTERS = [(a / 4.0, b / 4.0) for a in range(-11, 12) for b in range(a, min(a + 14, 12))]
ROUNDINGS: dict[str, Callable[[Any], Any]] = {"floor": np.floor, "i32": np.trunc}


def rounded(here: Context, name: str, x: Range) -> Any:
    return logic.floor(here, x) if name == "floor" else logic.to_integer(here, x, True)


def quarters(copies: int, cause: Array | None = None) -> Range:
    low, high = (column([box[k] for box in QUARTERS], copies) for k in (0, 1))
    return Range(low, high, cause)


@pytest.mark.parametrize("copies", COPIES)
@pytest.mark.parametrize("name", ROUNDINGS)
def test_every_integer_that_may_come(name: str, copies: int) -> None:
    x = quarters(copies)
    lanes = len(x.low)
    here = context(lanes)
    found = rounded(here, name, x)
    low, high = ROUNDINGS[name](x.low), ROUNDINGS[name](x.high)
    np.testing.assert_array_equal(np.broadcast_to(found.low, lanes), low)
    np.testing.assert_array_equal(np.broadcast_to(found.high, lanes), high)
    np.testing.assert_array_equal(here.first_fork, np.where(low < high, 0, -1))
    np.testing.assert_array_equal(here.width, np.where(low < high, high - low + 1, 0))


@pytest.mark.parametrize("name", ROUNDINGS)
def test_one_integer_where_a_way_is_told(name: str) -> None:
    apply = ROUNDINGS[name]
    rows = [(box, way) for box in QUARTERS for way in range(-1, int(apply(box[1]) - apply(box[0])) + 1)]
    x = Range(np.array([box[0] for box, _ in rows]), np.array([box[1] for box, _ in rows]))
    here = context(len(rows), np.array([way for _, way in rows]))
    found = rounded(here, name, x)
    for lane, ((low, high), way) in enumerate(rows):
        first, last = apply(low), apply(high)
        if way < 0 or first == last:
            assert (found.low[lane], found.high[lane]) == (first, last)
            assert (x.low[lane], x.high[lane]) == (low, high)
            continue
        chosen = first + way
        assert (found.low[lane], found.high[lane]) == (chosen, chosen)
        near = np.linspace(low, high, 4096)
        kept = near[apply(near) == chosen]
        assert x.low[lane] <= kept.min() and kept.max() <= x.high[lane]
        assert x.high[lane] - x.low[lane] <= kept.max() - kept.min() + 0.01


def test_integer_is_known_where_all_lanes_are_told_a_way() -> None:
    for ways, is_known in (([0, 1], True), ([0, -1], False)):
        here = context(2, np.array(ways))
        found = logic.to_integer(here, Range(np.array([0.5, 0.5]), np.array([1.5, 1.5])), True)
        assert found.is_point == is_known
        assert found.low.tolist() == [0, max(ways[1], 0)] and found.high.tolist() == [0, 1]


def test_too_many_integers_are_no_fork() -> None:
    ends = [MOST_WAYS - 1.5, MOST_WAYS - 0.5, MOST_WAYS + 0.5, 1e6]
    x = Range(np.full(4, 0.5), np.array(ends))
    here = context(4)
    found = logic.floor(here, x)
    np.testing.assert_array_equal(found.high, np.floor(ends))
    np.testing.assert_array_equal(here.first_fork, [0, 0, -1, -1])
    np.testing.assert_array_equal(here.width, [MOST_WAYS - 1, MOST_WAYS, 0, 0])


@pytest.mark.parametrize("is_signed", [True, False])
def test_conversion_beyond_the_type_may_give_anything(is_signed: bool) -> None:
    limits = (-(2.0**31), 2.0**31 - 1.0) if is_signed else (0.0, 2.0**32 - 1.0)
    rows = [limits, (limits[0], 0.0), (limits[0] - 0.5, 3.0), (limits[0] - 2.0, 3.0), (0.0, limits[1] + 1.0)]
    x = Range(np.array([r[0] for r in rows]), np.array([r[1] for r in rows]))
    found = logic.to_integer(context(len(rows)), x, is_signed)
    assert found.is_signed == is_signed
    assert found.cause is not None
    np.testing.assert_array_equal(found.cause > 0, [False, False, False, True, True])
    assert (found.low[3:] == limits[0]).all()
    assert (found.high[3:] == limits[1]).all()
    np.testing.assert_array_equal(found.low[:3], np.trunc([r[0] for r in rows[:3]]))
    np.testing.assert_array_equal(found.high[:3], np.trunc([r[1] for r in rows[:3]]))
    both = Range(x.low, x.high, np.array([0, 0, 0, 0, 7], np.int16))
    again = logic.to_integer(context(len(rows)), both, is_signed)
    assert again.cause is not None
    np.testing.assert_array_equal(again.cause > 0, [False, False, False, True, True])
    assert again.cause[4] == 7
    inherited = logic.to_integer(
        context(2), Range(np.zeros(2), np.ones(2), np.array([0, 3], np.int16)), is_signed
    )
    assert inherited.cause is not None
    np.testing.assert_array_equal(inherited.cause, [0, 3])


TRUTHS = [Truth(np.array([t]), np.array([f])) for t, f in ((True, False), (False, True), (True, True))]


def test_truth_values_are_joined_as_logic_says() -> None:
    both = [(True,), (False,), (True, False)]
    for (k, a), (m, b) in itertools.product(enumerate(TRUTHS), enumerate(TRUTHS)):
        for op, apply in (("and", operator.and_), ("or", operator.or_)):
            found = operations.binary(context(1), op, a, b)
            assert isinstance(found, Truth)
            results = {apply(x, y) for x in both[k] for y in both[m]}
            assert (bool(found.true[0]), bool(found.false[0])) == (True in results, False in results)
        found = operations.unary(context(1), "not", a)
        assert isinstance(found, Truth)
        assert (bool(found.true[0]), bool(found.false[0])) == (False in both[k], True in both[k])


@pytest.mark.parametrize("copies", COPIES)
@pytest.mark.parametrize("whole", [False, True])
def test_choice_is_the_hull_of_what_may_be_chosen(whole: bool, copies: int) -> None:
    rows = [(k, p) for k in range(3) for p in PAIRS]
    lanes = len(rows) * copies
    truth = [(True, False), (False, True), (True, True)]
    condition = Truth(*(column([truth[k][e] for k, _ in rows], copies, np.bool_) for e in (0, 1)))
    causes = [(np.arange(lanes) % 3 == e).astype(np.int16) * (e + 1) for e in (1, 2)]
    for codes in ([None, None], causes, [causes[0], None], [None, causes[1]]):
        sides = [operand([p[e] for _, p in rows], copies, whole, codes[e]) for e in (0, 1)]
        found: Any = choose(condition, sides[0], sides[1])
        assert isinstance(found, Whole if whole else Range)
        for lane in range(lanes):
            k, pair = rows[lane % len(rows)]
            chosen = [e for e in (0, 1) if truth[k][e]]
            assert found.low[lane] == min(pair[e][0] for e in chosen)
            assert found.high[lane] == max(pair[e][1] for e in chosen)
            seen = [codes[e][lane] for e in chosen if codes[e] is not None and codes[e][lane]]  # type: ignore[index]
            got = 0 if found.cause is None else found.cause[lane]
            assert got == (seen[0] if seen else 0)


def test_choice_between_truth_values_and_structs() -> None:
    for c, a, b in itertools.product(TRUTHS, TRUTHS, TRUTHS):
        found = choose(c, a, b)
        assert isinstance(found, Truth)
        sides = [side for side, may in ((a, c.true[0]), (b, c.false[0])) if may]
        assert bool(found.true[0]) == any(s.true[0] for s in sides)
        assert bool(found.false[0]) == any(s.false[0] for s in sides)
    one, two = constant(1.0, False), constant(2.0, False)
    open_ = TRUTHS[2]
    for made in (
        choose(open_, (one, one), (two, one)),
        choose(open_, {"a": one, "b": one}, {"a": two, "b": one}),
    ):
        parts: Any = list(made.values()) if isinstance(made, dict) else made
        assert [(p.low[0], p.high[0]) for p in parts] == [(1.0, 2.0), (1.0, 1.0)]
        assert parts[1] is one
