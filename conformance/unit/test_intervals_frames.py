"""What a call does with intervals: elements that lanes choose, loops with limits, literals, ways, causes.

Plan. Small functions as trees, with intervals as arguments; expected hulls listed by hand.
  elements   the hull of those that a number may name, the very value where it names one
  limits     as many rounds as the number says at least and at most, for signed and unsigned numbers; forks
             count as if all rounds had run
  literals   one value each, however often written; 0.0 and -0.0 are two, as are 1 of either type
  causes     name the function and line in which an operation stands, also beside a call
  ways       as many as are followed at a time, as deep as is promised, and no more
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import Place
from codegen.intervals import load_table, permitted
from codegen.intervals.causes import Cause, CauseBook
from codegen.intervals.context import Context
from codegen.intervals.interpreter import ALWAYS, Frame
from codegen.intervals.permit import Permitted
from codegen.intervals.values import Range, Value, Whole, constant
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, Type, array_of
from codegen.library import load_library
from conformance.unit.support.sources import library_of

LIBRARY = load_library()


def call(body: tuple[ir.Stmt, ...], arguments: dict[str, Value], lanes: int) -> Value:
    function = ir.Function("probe", "", "base", None, (), F32, body, ir.Doc("", {}), Place("", 1))
    return Frame(LIBRARY, Context(load_table("wgsl"), CauseBook(), lanes), function, arguments).run()


def wholes(signed: bool, *boxes: tuple[int, int]) -> Whole:
    return Whole(np.array([box[0] for box in boxes]), np.array([box[1] for box in boxes]), signed)


def ends(found: Value) -> list[tuple[float, float]]:
    assert isinstance(found, Range | Whole)
    return list(zip(found.low.tolist(), found.high.tolist(), strict=True))


def const(value: float) -> ir.Const:
    return ir.Const(F32, value)


@pytest.mark.parametrize("kind", [I32, U32])
def test_element_by_number(kind: Type) -> None:
    type_ = array_of(F32, 4)
    elements = ir.Construct(type_, tuple(const(x) for x in (3.0, 8.0, 1.0, 5.0)))
    body = (ir.Let("of", elements), ir.Return(ir.Index(F32, ir.Var(type_, "of"), ir.Var(kind, "k"))))
    boxes = [(0, 0), (1, 1), (2, 2), (3, 3), (0, 1), (1, 2), (2, 3), (0, 3), (1, 3)]
    expected = [(3, 3), (8, 8), (1, 1), (5, 5), (3, 8), (1, 8), (1, 5), (1, 8), (1, 8)]
    assert ends(call(body, {"k": wholes(kind == I32, *boxes)}, len(boxes))) == expected
    for k, value in enumerate((3.0, 8.0, 1.0, 5.0)):
        assert ends(call(body, {"k": wholes(kind == I32, (k, k))}, 1)) == [(value, value)]


def rounds(kind: Type, start: int, stop: int, limit: bool) -> tuple[ir.Stmt, ...]:
    """100, and the number of each round."""
    total = ir.Var(F32, "t")
    step = ir.Binary(F32, "+", total, ir.Convert(F32, ir.Var(kind, "i")))
    return (
        ir.Let("t", const(100.0)),
        ir.For("i", start, stop, (ir.Assign("t", step),), limit=ir.Var(kind, "n") if limit else None),
        ir.Return(total),
    )


@pytest.mark.parametrize("kind", [I32, U32])
def test_rounds_of_a_loop_with_a_limit(kind: Type) -> None:
    boxes = [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (9, 9), (0, 4), (1, 3), (2, 7)]
    sums = [100 + sum(range(n)) for n in range(5)]
    expected = [(sums[min(a, 4)], sums[min(b, 4)]) for a, b in boxes]
    assert ends(call(rounds(kind, 0, 4, True), {"n": wholes(kind == I32, *boxes)}, len(boxes))) == expected
    for a, b in boxes:
        found = call(rounds(kind, 0, 4, True), {"n": wholes(kind == I32, (a, b))}, 1)
        assert ends(found) == [(sums[min(a, 4)], sums[min(b, 4)])]
    later = call(rounds(kind, 2, 4, True), {"n": wholes(kind == I32, *boxes)}, len(boxes))
    tail = [100 + sum(range(2, n)) for n in range(5)]
    assert ends(later) == [(tail[min(a, 4)], tail[min(b, 4)]) for a, b in boxes]
    assert ends(call(rounds(I32, 1, 4, False), {}, 1)) == [(106, 106)]


@pytest.mark.parametrize(("start", "stop"), [(0, 4), (2, 5), (3, 3)])
@pytest.mark.parametrize("before", [0, 5])
def test_forks_of_a_loop_are_those_of_all_its_rounds(before: int, start: int, stop: int) -> None:
    """Whatever a limit leaves of them, and however many forks came before."""
    decided = ir.Binary(BOOL, "<", ir.Convert(F32, ir.Var(I32, "i")), const(99.0))
    body = (ir.Let("a", decided), ir.Let("b", ir.Builtin(F32, "floor", (const(0.5),))))
    loop = ir.For("i", start, stop, body, limit=ir.Var(I32, "n"))
    function = ir.Function("probe", "", "base", None, (), F32, (loop,), ir.Doc("", {}), Place("", 1))
    for n in range(7):
        here = Context(load_table("wgsl"), CauseBook(), 1, forks=before)
        Frame(LIBRARY, here, function, {"n": wholes(True, (n, n))}).block(function.body, ALWAYS)
        assert here.forks == before + 2 * (stop - start)


@pytest.mark.parametrize(("rounds_run", "told"), [((0, 0), 0), ((1, 2), 0), ((3, 3), 1), ((2, 9), 1)])
def test_rounds_that_no_lane_runs_tell_no_cause(rounds_run: tuple[int, int], told: int) -> None:
    """They are not evaluated: what may be anything there is nobody's."""
    divisor = ir.Binary(F32, "-", const(2.0), ir.Convert(F32, ir.Var(I32, "i")))
    step = ir.Let("a", ir.Binary(F32, "/", const(1.0), divisor))
    function = ir.Function("probe", "", "base", None, (), F32, (), ir.Doc("", {}), Place("", 1))
    here = Context(load_table("wgsl"), CauseBook(), 1)
    loop = ir.For("i", 0, 4, (step,), limit=ir.Var(I32, "n"))
    with np.errstate(all="ignore"):
        Frame(LIBRARY, here, function, {"n": wholes(True, rounds_run)}).block((loop,), ALWAYS)
    assert len(here.book.causes) == told


def test_forks_of_a_loop_in_a_loop_are_those_of_all_rounds_of_both() -> None:
    step, limit = ir.Let("b", ir.Builtin(F32, "floor", (const(0.5),))), ir.Var(I32, "n")
    loop = ir.For("i", 0, 4, (step, ir.For("k", 0, 3, (step, step), limit=limit)), limit=limit)
    function = ir.Function("probe", "", "base", None, (), F32, (loop,), ir.Doc("", {}), Place("", 1))
    for n in range(5):
        here = Context(load_table("wgsl"), CauseBook(), 1)
        Frame(LIBRARY, here, function, {"n": wholes(True, (n, n))}).block(function.body, ALWAYS)
        assert here.forks == 4 * (1 + 2 * 3)


@pytest.mark.parametrize("kind", [I32, U32])
def test_number_of_a_round_has_the_type_of_its_limit(kind: Type) -> None:
    body = (
        ir.Let("t", ir.Var(kind, "n")),
        ir.For("i", 0, 2, (ir.Assign("t", ir.Var(kind, "i")),), limit=ir.Var(kind, "n")),
        ir.Return(ir.Var(kind, "t")),
    )
    found = call(body, {"n": wholes(kind == I32, (5, 5))}, 1)
    assert isinstance(found, Whole) and found.is_signed == (kind == I32) and ends(found) == [(1, 1)]


@pytest.mark.parametrize("first", [I32, U32])
def test_rounds_of_two_loops_have_numbers_of_their_own_types(first: Type) -> None:
    second = U32 if first == I32 else I32
    body = (
        ir.Let("t", ir.Var(second, "m")),
        ir.For("i", 0, 2, (ir.Let("s", ir.Var(first, "i")),), limit=ir.Var(first, "n")),
        ir.For("k", 0, 2, (ir.Assign("t", ir.Var(second, "k")),), limit=ir.Var(second, "m")),
        ir.Return(ir.Var(second, "t")),
    )
    found = call(body, {"n": wholes(first == I32, (5, 5)), "m": wholes(second == I32, (5, 5))}, 1)
    assert isinstance(found, Whole) and found.is_signed == (second == I32) and ends(found) == [(1, 1)]


def test_unsigned_number_of_a_round_is_the_literal() -> None:
    """One value, so that x f32(i) - x f32(1u) is 0 in the round of 1."""
    limit = ir.Var(U32, "n")
    body = (ir.For("i", 0, 2, (ir.Let("s", ir.Var(U32, "i")),), limit=limit), ir.Return(limit))
    for literal_first in (False, True):
        function = ir.Function("probe", "", "base", None, (), U32, body, ir.Doc("", {}), Place("", 1))
        here = Context(load_table("wgsl"), CauseBook(), 1)
        frame = Frame(LIBRARY, here, function, {"n": wholes(False, (5, 5))})
        if literal_first:
            frame.expr(ir.Const(U32, 1))
        frame.run()
        assert frame.scope["i"] is frame.expr(ir.Const(U32, 1))


def test_truth_values_given_as_inputs() -> None:
    sure = np.array([True, False, True])
    chosen = ir.Select(F32, ir.Var(BOOL, "b"), const(2.0), const(5.0))
    for returns, value, expected in ((BOOL, ir.Var(BOOL, "b"), sure), (F32, chosen, [2.0, 5.0, 2.0])):
        parameters = (ir.Parameter("b", BOOL, None),)
        body = (ir.Return(value),)
        f = ir.Function("told", "", "base", None, parameters, returns, body, ir.Doc("", {}), Place("", 1))
        found: Any = permitted(LIBRARY.with_functions([f]), "told", {"b": sure}, "wgsl")
        assert found.low.tolist() == found.high.tolist() == list(expected)


def test_literals_are_one_value_each() -> None:
    context = Context(load_table("wgsl"), CauseBook(), 1)
    function = ir.Function("probe", "", "base", None, (), F32, (), ir.Doc("", {}), Place("", 1))
    frame = Frame(LIBRARY, context, function, {})
    literals: Any = [(F32, 1.0), (I32, 1), (U32, 1), (F32, 0.0), (F32, -0.0), (F32, 2.0)]
    seen: Any = [frame.expr(ir.Const(type_, number)) for type_, number in literals]
    assert len({value.number for value in seen}) == len(literals)
    for value, (type_, number) in zip(seen, literals, strict=True):
        assert value.low[0] == number and np.signbit(value.low[0]) == np.signbit(number)
        assert isinstance(value, Range if type_ == F32 else Whole)
        if isinstance(value, Whole):
            assert value.is_signed == (type_ == I32)
        assert frame.expr(ir.Const(type_, number)) is value
    one = ir.Const(F32, 7.0)
    assert frame.expr(one) is frame.expr(one)
    assert Frame(LIBRARY, context, function, {}).expr(ir.Const(F32, 7.0)) is frame.expr(one)


def test_float_as_a_float_is_the_value_itself() -> None:
    function = ir.Function("probe", "", "base", None, (), F32, (), ir.Doc("", {}), Place("", 1))
    x = Range(np.array([0.25]), np.array([1.75]))
    frame = Frame(LIBRARY, Context(load_table("wgsl"), CauseBook(), 1), function, {"x": x})
    assert frame.expr(ir.Convert(F32, ir.Var(F32, "x"))) is x


CALLS = """@helper
def turned(x: X) -> f32:
    y = x * 2.0
    return 1.0 / y


def probe(x: X, z: X) -> vec2:
    a = turned(x + 1.0)
    b = turned(x) + log(z)
    if z > 9.0:
        b = 1.0 / (z - 10.0)
    return vec2(a, b)
"""


def test_causes_name_the_place_of_their_operation(tmp_path: Path) -> None:
    x, z = np.array([1, -1, 0, 1, 1], np.float32), np.array([1, 1, 1, 0, 10], np.float32)
    found = permitted(library_of(tmp_path, CALLS), "probe", {"x": x, "z": z}, "wgsl")
    lines = CALLS.splitlines()
    divided, logarithm = lines.index("    return 1.0 / y") + 2, lines.index("    b = turned(x) + log(z)") + 2
    last = lines.index("        b = 1.0 / (z - 10.0)") + 2
    told = [None if code == 0 else found.causes[code - 1] for code in found.codes]
    zero = "the divisor may be 0"
    assert told == [
        None,
        Cause("turned", divided, "/", "y", zero),
        Cause("turned", divided, "/", "y", zero),
        Cause("probe", logarithm, "log", "x", "x may be 0 or less"),
        Cause("probe", last, "/", "y", zero),
    ]


def test_input_that_is_not_finite_is_told_where_the_function_begins(tmp_path: Path) -> None:
    text = "\n\ndef probe(x: X) -> f32:\n    return x + 1.0\n"
    library = library_of(tmp_path, text)
    found = permitted(library, "probe", {"x": np.array([np.inf, 1.0], np.float32)}, "wgsl")
    assert found.guaranteed.tolist() == [False, True]
    line = library.function("probe").place.line
    assert found.causes == (Cause("probe", line, "input", "", "the input is not finite"),)


STEP = float(2**23)
WIDE = """def probe(x: X, y: X, t: X) -> f32:
    d = ((x + t) - 1.0) * 8388608.0
    e = ((y + t) - 1.0) * 8388608.0
    a = floor(d * {0}.0)
    b = floor(e * {1}.0)
    return a * (3.0 - a) + b * (1.0 - b)
"""
"""d and e are each anything from 0 to 1, whatever the other is."""


@pytest.mark.parametrize(("first", "second"), [(7, 3), (10, 2), (3, 7), (15, 1), (16, 1), (30, 0), (23, 0)])
def test_32_ways_are_followed_at_a_time(first: int, second: int, tmp_path: Path) -> None:
    """Of one fork 24, of two forks of a lane 32 together; a hull knows nothing of a (3 - a)."""
    one = np.ones(1, np.float32)
    library = library_of(tmp_path, WIDE.format(first, second))
    found: Any = permitted(library, "probe", {"x": one, "y": one, "t": np.full(1, 1e-12, np.float32)}, "wgsl")
    a = [k * (3 - k) for k in range(first + 1)]
    b = [k * (1 - k) for k in range(second + 1)]
    followed = min(a) + min(b), max(a) + max(b)
    ways = (first + 1) * (second + 1)
    if ways <= 32 and first < 24:
        assert (found.low[0], found.high[0]) == followed
    else:
        assert found.high[0] > followed[1] and found.low[0] <= followed[0]


@pytest.mark.parametrize(("count", "guaranteed"), [(6, True), (7, False)])
def test_a_lane_is_followed_through_six_forks(count: int, guaranteed: bool, tmp_path: Path) -> None:
    """Thresholds one after another, each of which leaves one way open; the last tells that s is not 0."""
    steps = "".join(f"    y{k} = 1.0 if d > {k + 1}.0 else 2.0\n" for k in range(count - 1))
    total = " + ".join(f"y{k}" for k in range(count - 1))
    text = (
        "def probe(x: X, t: X) -> f32:\n    d = ((x + t) - 1.0) * 167772160.0\n"
        f"{steps}    s = 1.0 if d > {count}.0 else -1.0\n    return {total} + 1.0 / s\n"
    )
    inputs = {"x": np.ones(1, np.float32), "t": np.full(1, 1e-12, np.float32)}
    assert permitted(library_of(tmp_path, text), "probe", inputs, "wgsl").guaranteed.tolist() == [guaranteed]


def test_causes_that_are_as_frequent_come_in_their_order() -> None:
    causes = tuple(Cause("f", line, "/", "y", "why") for line in range(60))
    codes = np.array([*range(60, 0, -1), 31], np.int16)
    zero = np.zeros(61)
    found = list(Permitted(zero, zero, codes, causes).histogram())
    assert found == [causes[30], *causes[:30], *causes[31:]]


def test_constants_are_shared_by_all_lanes() -> None:
    assert ends(constant(2.5, False)) == [(2.5, 2.5)] and ends(constant(7, True)) == [(7, 7)]
