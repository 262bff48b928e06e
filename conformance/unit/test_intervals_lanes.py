"""What lanes carry along: causes and their numbers, forks and the ways told, choices, which loops are wanted.

Plan. Small values by hand.
  causes     numbered from 1 on, each once; the first of several stays, lane by lane
  forks      a lane notes its first open fork and how many ways it has; ways are told by fork, not by depth
  values     literals, truth values, what is shared and what is one value; choices keep what is decided
  operators  tell the cause of the first operand
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from codegen.intervals import arithmetic, compiled, elementary, geometry, load_table, operations
from codegen.intervals.causes import Cause, CauseBook, first, mark
from codegen.intervals.context import Context, Ways
from codegen.intervals.values import Range, Truth, Whole, all_of, always, any_of, choose, constant, opposite


def codes(*values: int) -> Any:
    return np.array(values, np.int16)


def context(lanes: int, ways: Ways | None = None, table: str = "wgsl") -> Context:
    return Context(load_table(table), CauseBook(), lanes, ways)


def test_causes_are_numbered_once_from_1() -> None:
    book = CauseBook()
    one, other = Cause("f", 1, "/", "y", "0"), Cause("f", 2, "/", "y", "0")
    assert [book.code(c) for c in (one, other, one, Cause("f", 1, "/", "y", "0"))] == [1, 2, 1, 1]
    assert book.causes == [one, other]


def test_first_cause_of_each_lane() -> None:
    assert first() is None and first(None, None) is None
    a = codes(0, 5, 0)
    assert first(None, a, None) is a
    found = first(a, None, codes(7, 7, 0), codes(9, 9, 9))
    assert found is not None and found.tolist() == [7, 5, 9]
    found = first(codes(1), codes(0, 2))
    assert found is not None and found.tolist() == [1, 1]


def test_marked_lanes_keep_earlier_causes() -> None:
    mask = np.array([True, True, False])
    fresh = mark(None, mask, 3)
    assert fresh is not None and fresh.tolist() == [3, 3, 0] and fresh.dtype == np.int16
    found = mark(codes(5, 0, 0), mask, 3)
    assert found is not None and found.tolist() == [5, 3, 0]


def test_cause_is_where_the_evaluation_is() -> None:
    here = context(2)
    here.function, here.line, here.operation = "shade", 12, "log"
    assert here.unbounded(None, np.array([False, False]), "x", "never") is None
    a = codes(0, 4)
    assert here.unbounded(a, np.array([False, False]), "x", "never") is a
    assert here.book.causes == []
    found = here.unbounded(None, np.array([False, True]), "x", "x may be 0 or less")
    assert found is not None and found.tolist() == [0, 1]
    assert here.book.causes == [Cause("shade", 12, "log", "x", "x may be 0 or less")]
    assert str(here.book.causes[0]) == "line 12 of shade: log of x: x may be 0 or less"
    assert here.book.causes[0].what == "shade: log of x: x may be 0 or less"
    assert Cause("f", 1, "*", "", "it may").what == "f: *: it may"


def ways(forks: list[list[int]], taken: list[list[int]]) -> Ways:
    return Ways(np.array(forks, np.int32), np.array(taken, np.int32))


def test_way_of_each_lane_at_a_fork() -> None:
    told = ways([[0, 2], [2, 5], [0, 5], [3, 4]], [[1, 0], [3, 2], [0, 1], [7, 7]])
    expected = {0: [1, -1, 0, -1], 1: None, 2: [0, 3, -1, -1], 3: [-1, -1, -1, 7], 5: [-1, 2, 1, -1], 6: None}
    for fork, at in expected.items():
        found = told.at(fork)
        assert (None if found is None else found.tolist()) == at
    assert Ways(np.empty((2, 0), np.int32), np.empty((2, 0), np.int32)).at(0) is None


def test_a_way_more() -> None:
    told = ways([[0], [1], [2]], [[5], [6], [7]])
    found = told.then(np.array([2, 0, 0]), np.array([8, 9, 9]), np.array([0, 0, 1]))
    assert found.forks.tolist() == [[2, 8], [0, 9], [0, 9]]
    assert found.ways.tolist() == [[7, 0], [5, 0], [5, 1]]


def test_first_open_fork_is_noted() -> None:
    here = context(6)
    assert here.first_fork.tolist() == [-1] * 6 and here.width.tolist() == [0] * 6
    assert here.fork(np.array([1, 2, 24, 25, 1, 1])) is None
    assert here.fork(np.array([3, 3, 3, 3, 1, 1])) is None
    here.decided()
    assert here.fork(np.array([4])) is None
    assert here.first_fork.tolist() == [1, 0, 0, 1, 3, 3]
    assert here.width.tolist() == [3, 2, 24, 3, 4, 4]
    assert here.forks == 4


def test_told_lanes_note_later_forks() -> None:
    """A lane that was told its way at a fork is not open there; one that was not is."""
    told = ways([[0], [0], [1]], [[0], [1], [0]])
    here = context(3, told)
    assert not here.memory.forgets and context(3).memory.forgets
    found = here.fork(np.array([2, 2, 2]))
    assert found is not None and found.tolist() == [0, 1, -1]
    found = here.fork(np.array([2, 1, 2]))
    assert found is not None and found.tolist() == [-1, -1, 0]
    assert here.fork(np.array([1, 5, 5])) is None
    assert here.first_fork.tolist() == [1, 2, 0] and here.width.tolist() == [2, 5, 2]


def test_loops_are_wanted_from_so_many_lanes_on() -> None:
    pytest.importorskip("numba")
    assert [compiled.wanted(n) for n in (1, compiled.FEWEST - 1, compiled.FEWEST)] == [False, False, True]
    assert compiled.FEWEST == 1024 and compiled.kernels() is compiled.found()
    assert context(1024).loops and not context(1023).loops
    both = np.array([1.0, 2.0]), np.array([3.0, 4.0])
    assert compiled.ends(*both) == both and compiled.ends(both[0][:1], both[1][:1]) == (1.0, 3.0)


def truth(*pairs: tuple[bool, bool]) -> Truth:
    return Truth(np.array([p[0] for p in pairs]), np.array([p[1] for p in pairs]))


def test_literals() -> None:
    for value in (True, False):
        for made in (constant(value, False), always(value)):
            assert isinstance(made, Truth) and (made.true.tolist(), made.false.tolist()) == (
                [value],
                [not value],
            )
    for signed in (True, False):
        whole = constant(7, signed)
        assert isinstance(whole, Whole) and whole.is_point and whole.is_signed == signed
        assert whole.low.tolist() == [7] and whole.low.dtype == np.int64
    single = constant(0.5, True)
    assert isinstance(single, Range) and single.is_point and single.low.tolist() == [0.5]
    assert truth((True, True), (True, False)).undecided.tolist() == [True, False]
    numbers = [constant(1.0, False).number for _ in range(3)]
    assert len(set(numbers)) == 3


def test_values_that_are_cut_forget_how_far_they_reached() -> None:
    x = Range(np.array([-1.0, 2.0]), np.array([3.0, 4.0]))
    assert x.reach == (-1.0, 4.0, 1.0) and x.known == x.reach
    x.cut(np.array([2.0, 2.0]), np.array([3.0, 3.5]))
    assert x.reach == (2.0, 3.5, 2.0)
    assert Whole(x.low, x.high, True).limits == (-(2**31), 2**31 - 1)
    assert Whole(x.low, x.high, False).limits == (0, 2**32 - 1)


def test_decided_choices_give_the_chosen_value_itself() -> None:
    a, b = constant(1.0, False), constant(2.0, False)
    yes, no, either = truth((True, False)), truth((False, True)), truth((True, True))
    pair, struct = (a, b), {"a": a}
    sides: list[tuple[Any, Any]] = [(a, b), (pair, (b, a)), (struct, {"a": b})]
    for value, other in sides:
        assert choose(yes, value, other) is value and choose(no, value, other) is other
        assert choose(either, value, value) is value
    mixed = truth((True, False), (False, True))
    found = choose(mixed, a, b)
    assert isinstance(found, Range) and found.is_point and found.low.tolist() == [1.0, 2.0]
    wide = Range(np.array([5.0, 5.0]), np.array([6.0, 6.0]))
    for order, ends in (((a, wide), [(1.0, 1.0), (5.0, 6.0)]), ((wide, a), [(5.0, 6.0), (1.0, 1.0)])):
        found = choose(mixed, *order)
        assert isinstance(found, Range) and list(zip(found.low, found.high, strict=True)) == ends
    for signed in (True, False):
        found = choose(mixed, constant(3, signed), constant(4, signed))
        assert isinstance(found, Whole) and found.is_signed == signed and found.low.tolist() == [3, 4]


def test_truth_tables() -> None:
    a, b = truth((True, False), (True, True), (False, True)), truth((True, True), (True, False), (True, True))
    for made, true, false in (
        (all_of(a, b), [True, True, False], [True, True, True]),
        (any_of(a, b), [True, True, True], [False, False, True]),
        (opposite(a), [False, True, True], [True, True, False]),
    ):
        assert (made.true.tolist(), made.false.tolist()) == (true, false)


def number(cause: int | None, value: float = 0.5) -> Range:
    known = np.array([value])
    return Range(known, known + 0.25, None if cause is None else codes(cause))


OPERATORS: dict[str, Callable[[Context, Any, Any], Any]] = {
    op: lambda context, a, b, op=op: operations.binary(context, op, a, b)  # type: ignore[misc]
    for op in ("+", "-", "*", "/")
}
OPERATORS["min"] = lambda context, a, b: arithmetic.smaller(a, b)
OPERATORS["max"] = lambda context, a, b: arithmetic.larger(a, b)
OPERATORS["atan2"] = elementary.arc_tangent


@pytest.mark.parametrize("table", ["wgsl", "opencl"])
@pytest.mark.parametrize("op", OPERATORS)
def test_cause_of_the_first_operand(op: str, table: str) -> None:
    for pair, expected in (((5, 7), 5), ((None, 7), 7), ((5, None), 5)):
        here = context(1, table=table)
        found = OPERATORS[op](here, *(number(c) for c in pair))
        assert found.cause.tolist() == [expected]
        assert (found.low.tolist(), found.high.tolist()) == ([-np.inf], [np.inf])
        assert here.book.causes == []


@pytest.mark.parametrize("table", ["wgsl", "opencl", "vulkan"])
def test_cause_of_the_first_vector(table: str) -> None:
    """And, within it, of its first component."""
    free = tuple(number(None, 0.5 + k) for k in range(3))
    told = [tuple(number(c, 0.5) for c in row) for row in ((5, 7, 9), (2, 3, 4))]
    here = context(1, table=table)
    with np.errstate(all="ignore"):
        dots = [
            geometry.dot(here, told[0], told[1]),
            geometry.dot(here, (number(5), *free[1:]), told[1]),
            geometry.dot(here, free, told[1]),
            geometry.dot(here, (free[0], *told[0][1:]), free),
            geometry.length(here, told[0]),
        ]
        shares = [*geometry.normalize(here, told[0]), *geometry.cross(here, told[0], free)]
        both = geometry.cross(here, told[0], told[1])
        second = geometry.cross(here, (free[0], free[1], number(6)), (free[0], number(8), free[2]))
    assert [code(x) for x in dots] == [5, 5, 2, 7, 5]
    assert all(code(x) in (5, 7, 9) for x in shares)
    # Formulas are evaluated as they stand: a[1] b[2] - a[2] b[1] and so on; else the operation is one.
    assert [code(x) for x in both] == ([5, 5, 5] if table == "opencl" else [7, 9, 5])
    assert code(second[0]) == 6


def code(x: Range) -> int:
    assert x.cause is not None
    return int(x.cause[0])


@pytest.mark.parametrize("mask", [(None, 7, 9), (5, None, 9), (None, None, 9), (5, 7, None)])
def test_cause_of_a_clamp(mask: tuple[int | None, ...]) -> None:
    x, least, most = (number(c, v) for c, v in zip(mask, (0.5, 0.0, 1.0), strict=True))
    found = arithmetic.clamp(x, least, most)
    assert found.cause == codes(next(c for c in mask if c))
    crossed = arithmetic.clamp(x, most, least)
    assert crossed.cause is not None and crossed.cause[0] in mask
