"""Facts and lengths narrow ranges, each by what it says and no more.

Plan. Small values over parameters in ranges; ends in units of the slack of a fact, 2^-19 of its size or of 1.
  facts    of scalars, vectors, elements of arrays; with one end or two; of what is known and what is not
  both     a fact and a range: the narrower of either end; where they exclude each other, an error with both
  leaves   constants, loop variables, calls, fields, structs that calls are given
  lengths  narrow every component and dot and length; what may overflow they do not
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.intervals.numbers import LARGEST, SMALLEST
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Finite, Interval, Length, Unit
from codegen.ir.types import BOOL, F32, I32, U32, VEC2, VEC3, Field, Struct, Type, array_of
from codegen.passes.analysis.ranges import Bounds, Ranges, ends
from codegen.passes.rules.scalars import components
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Values
from conformance.unit.support.tolerances import tolerance

SLACK = 2.0**-19
NEAR = tolerance("range_of_cosines")
SAME = 1e-3
"""Ends nearer than this to the given fact are the fact itself: other cases differ by a tenth or more."""
PAIR = Struct("Pair", (Field("first", F32), Field("second", I32)))
PARAMETERS: dict[str, tuple[Type, Domain | None]] = {
    "x": (F32, Interval(-1.0, 1.0)),
    "y": (F32, Interval(-1.0, 1.0)),
    "k": (F32, Interval(0.0, 300.0)),
    "f": (F32, None),
    "v": (VEC3, Interval(-1.0, 1.0)),
    "w": (VEC3, Length(0.0, 0.5)),
    "q": (VEC2, None),
    "u": (VEC3, Unit()),
    "a": (array_of(F32, 3), Interval(-1.0, 1.0)),
    "b": (array_of(VEC3, 2), Unit()),
    "s": (PAIR, None),
    "i": (I32, Interval(0.0, 9.0)),
    "n": (U32, None),
    "p": (BOOL, None),
}


def known(indices: dict[str, tuple[int, int]] | None = None) -> tuple[Values, Ranges, dict[str, ir.Expr]]:
    parameters = {n: ir.Parameter(n, t, d) for n, (t, d) in PARAMETERS.items()}
    values = Values(rules=(components,), parameters=parameters, indices=indices or {})
    return values, Ranges(values), {n: values.intern(ir.Var(t, n)) for n, (t, _) in PARAMETERS.items()}


def made(values: Values, found: dict[str, ir.Expr], text: str, type_: Type = F32) -> ir.Expr:
    return patterns.make(patterns.parse(text), found, values, type_)


FACTS: dict[str, tuple[str, Type, tuple[float, float], tuple[float, float]]] = {
    "both ends": ("x * y", F32, (0.5, 0.75), (0.5 - SLACK, 0.75 + SLACK)),
    "negative ends": ("x * y", F32, (-0.75, -0.5), (-0.75 - SLACK, -0.5 + SLACK)),
    "large ends": ("k * k", F32, (100.0, 200.0), (100.0 - 200.0 * SLACK, 200.0 + 200.0 * SLACK)),
    "large negative ends": ("k - k * k", F32, (-200.0, -100.0), (-200.0 - 200 * SLACK, -100.0 + 200 * SLACK)),
    "one number": ("x * y", F32, (0.5, 0.5), (0.5 - SLACK, 0.5 + SLACK)),
    "wider than the range": ("x * 0.5", F32, (-3.0, 3.0), (-0.5, 0.5)),
    "low end alone": ("x * 0.5", F32, (0.25, math.inf), (0.25 - SLACK, 0.5)),
    "high end alone": ("x * 0.5", F32, (-math.inf, 0.25), (-0.5, 0.25 + SLACK)),
    "of the unknown": ("f * x", F32, (0.5, 2.0), (0.5 - 2 * SLACK, 2.0 + 2 * SLACK)),
    "a parameter of which nothing is known": ("f", F32, (0.5, 2.0), (0.5 - 2 * SLACK, 2.0 + 2 * SLACK)),
    "half of the unknown": ("f * x", F32, (0.5, math.inf), (-math.inf, math.inf)),
    "touching": ("x * 0.5", F32, (0.5, 2.0), (0.5 - 2.0 * SLACK, 0.5)),
    "vector": ("v * 0.5", VEC3, (0.25, 0.375), (0.25 - SLACK, 0.375 + SLACK)),
    "unknown vector": ("q * x", VEC2, (0.25, 0.5), (0.25 - SLACK, 0.5 + SLACK)),
    "cosine": ("dot(u, w)", F32, (0.25, 9.0), (0.25 - 9.0 * SLACK, 0.5)),
    "length": ("length(w)", F32, (0.25, 9.0), (0.25 - 9.0 * SLACK, 0.5)),
}


@pytest.mark.parametrize("name", FACTS)
def test_fact_narrows_by_what_it_says(name: str) -> None:
    text, type_, fact, (low, high) = FACTS[name]
    values, ranges, found = known()
    e = made(values, found, text, type_)
    ranges.add_fact(e, *fact)
    ranges.check_facts()
    for bound in ranges.bounds(e):
        for got, wanted, given, side in ((bound.low, low, fact[0], -1.0), (bound.high, high, fact[1], 1.0)):
            if math.isinf(wanted) or abs(wanted - given) < SAME:
                assert got == wanted
            else:
                assert 0.0 <= side * (got - wanted) <= NEAR * max(1.0, abs(wanted))
    other = made(values, found, "x * 0.75")
    assert ranges.bounds(other)[0].low == pytest.approx(-0.75, abs=NEAR)


CONTRADICTIONS = {
    "x * 0.5": ((2.0, 3.0), "[1.99999, 3.00001]", "[-0.5, 0.5]"),
    "y * 0.5": ((-4.0, -3.0), "[-4.00001, -2.99999]", "[-0.5, 0.5]"),
    "dot(w, w)": ((1.0, 2.0), "[0.999996, 2]", "[0, 0.250001]"),
    "dot(u, w)": ((-2.0, -1.0), "[-2, -0.999996]", "[-0.500004, 0.500004]"),
}  # fmt: skip


@pytest.mark.parametrize("text", CONTRADICTIONS)
def test_fact_that_cannot_be_is_told_with_the_ranges(text: str) -> None:
    fact, given, possible = CONTRADICTIONS[text]
    values, ranges, found = known()
    ranges.add_fact(made(values, found, text), *fact)
    with pytest.raises(UserError) as refused:
        ranges.check_facts()
    told = f'fact "{text}" in {given} contradicts the ranges, which give {possible}'
    assert str(refused.value) == told


def test_fact_of_an_array_speaks_of_each_element() -> None:
    values, ranges, found = known()
    whichever = values.intern(ir.Index(F32, found["a"], values.intern(ir.Var(I32, "any element"))))
    ranges.add_fact(values.binary("*", whichever, found["x"]), 0.25, 0.5)
    element = values.intern(ir.Index(F32, found["a"], found["i"]))
    (bound,) = ranges.bounds(values.binary("*", element, found["x"]))
    assert (bound.low, bound.high) == (0.25 - SLACK, 0.5 + SLACK)
    (bound,) = ranges.bounds(values.binary("*", element, found["y"]))
    assert bound.low == -1.0
    (bound,) = ranges.bounds(values.binary("+", element, found["x"]))
    assert bound.low == pytest.approx(-2.0, abs=NEAR)


def test_facts_come_before_questions() -> None:
    values, ranges, found = known()
    ranges.bounds(found["x"])
    with pytest.raises(AssertionError):
        ranges.add_fact(found["x"], 0.0, 1.0)
    assert values.log == []


def test_leaves() -> None:
    values, ranges, found = known({"j": (2, 7)})
    index = values.intern(ir.Var(I32, "j"))
    whole, every = (-(2.0**31), 2.0**31 - 1.0), (0.0, 2.0**32 - 1.0)
    anything = (-math.inf, math.inf)
    constant = values.build(ir.Construct(VEC2, (values.number(0.5, F32), values.number(-3.0, F32))))
    cases: list[tuple[ir.Expr, list[tuple[float, float]]]] = [
        (index, [(2.0, 7.0)]),
        (found["i"], [(0.0, 9.0)]),
        (found["n"], [every]),
        (found["p"], [(0.0, 1.0)]),
        (values.number(-7, I32), [(-7.0, -7.0)]),
        (values.number(4_294_967_295, U32), [(4_294_967_295.0,) * 2]),
        (values.number(True, BOOL), [(1.0, 1.0)]),
        (values.number(False, BOOL), [(0.0, 0.0)]),
        (values.number(0.1, F32), [(0.1, 0.1)]),
        (constant, [(0.5, 0.5), (-3.0, -3.0)]),
        (values.build(ir.Call(F32, "g", ())), [anything]),
        (values.build(ir.Call(VEC3, "g_vec3", ())), [anything] * 3),
        (values.build(ir.Call(U32, "g_u32", ())), [every]),
        (values.build(ir.Call(I32, "g_i32", ())), [whole]),
        (values.build(ir.Call(BOOL, "g_bool", ())), [(0.0, 1.0)]),
        (values.build(ir.Member(F32, found["s"], "first")), [anything]),
        (values.build(ir.Member(I32, found["s"], "second")), [whole]),
        (values.build(ir.Construct(PAIR, (found["x"], found["i"]))), []),
        (values.intern(ir.Var(F32, "stranger")), [anything]),
        (values.intern(ir.Var(VEC2, "stranger of two")), [anything] * 2),
    ]
    for e, wanted in cases:
        assert [(b.low, b.high) for b in ranges.bounds(e)] == wanted, values.show(e)
    given = values.build(ir.Call(F32, "g", (values.build(ir.Construct(PAIR, (found["x"], found["i"]))),)))
    assert not ranges.bounds(given)[0].finite
    for name, size in (("a", 1), ("b", 3)):
        element = values.intern(ir.Index(found["u"].type if size == 3 else F32, found[name], index))
        assert [b.finite for b in ranges.bounds(element)] == [True] * size


def test_vectors_are_no_longer_than_they_are() -> None:
    values, ranges, found = known()
    for text, most in (("w + w", 1.0), ("w + u", 1.5), ("u - u", 2.0), ("w * x", 0.5)):
        for bound in ranges.bounds(made(values, found, text, VEC3)):
            assert most <= bound.high <= most + NEAR or text == "u - u"
            assert -most - NEAR <= bound.low <= -most or text == "u - u"
    (bound,) = ranges.bounds(made(values, found, "length(u)"))
    assert 1.0 - NEAR < bound.low < 1.0 - SLACK
    assert 1.0 + SLACK < bound.high < 1.0 + NEAR
    (bound,) = ranges.bounds(made(values, found, "length(u + 0.5 * u)"))
    assert bound.low == pytest.approx(0.5, abs=NEAR) or bound.low > 0.5
    assert bound.high == pytest.approx(1.5, abs=NEAR)


def test_lengths_say_nothing_of_what_may_overflow() -> None:
    values, ranges, found = known()
    unbounded = made(values, found, "q * inverse_sqrt(dot(q, q))", VEC2)
    assert [b.finite for b in ranges.bounds(unbounded)] == [False, False]


ENDS: list[tuple[Domain, tuple[float, float]]] = [
    (Interval(0.25, 2.0), (0.25, 2.0)),
    (Interval(0.1, 0.1), (0.1, float(np.float32(0.1)))),
    (Interval(0.7, 0.7), (float(np.float32(0.7)), 0.7)),
    (Unit(), (-1.0 - SLACK, 1.0 + SLACK)),
    (Length(0.5, 4.0), (-4.0 - 4.0 * SLACK, 4.0 + 4.0 * SLACK)),
    (Finite(), (-LARGEST, LARGEST)),
]


@pytest.mark.parametrize(("domain", "expected"), ENDS, ids=str)
def test_ends_of_a_domain_hold_its_float32_numbers(domain: Domain, expected: tuple[float, float]) -> None:
    assert ends(domain) == expected


DENORMAL: list[tuple[tuple[float, float], tuple[float, float]]] = [
    ((1e-40, 1.0), (0.0, 1.0)),
    ((-1.0, -1e-40), (-1.0, 0.0)),
    ((SMALLEST, 1.0), (SMALLEST, 1.0)),
    ((-1.0, -SMALLEST), (-1.0, -SMALLEST)),
    ((0.0, 1.0), (0.0, 1.0)),
    ((-1.0, 0.0), (-1.0, 0.0)),
    ((-1e-40, 1.0), (-1e-40, 1.0)),
]


@pytest.mark.parametrize(("given", "expected"), DENORMAL)
def test_what_is_denormal_may_be_read_as_zero(
    given: tuple[float, float], expected: tuple[float, float]
) -> None:
    values = Values(parameters={"x": ir.Parameter("x", F32, Interval(*given))})
    (bound,) = Ranges(values).bounds(values.intern(ir.Var(F32, "x")))
    assert (bound.low, bound.high) == pytest.approx(expected, rel=NEAR, abs=0.0)


def test_bounds_tell_whether_anything_is_known() -> None:
    assert Bounds(0.0, 1.0).finite
    assert not Bounds(-math.inf, 1.0).finite
    assert not Bounds(0.0, math.inf).finite
    assert str(Bounds(-1.0 / 3.0, 1234567.0)) == "[-0.333333, 1.23457e+06]"


def test_operations_share_what_tables_say_alike() -> None:
    """One value at every table: a difference with itself is 0 under each, a square is not negative."""
    values, ranges, found = known()
    assert ranges.bounds(made(values, found, "x - x")) == (Bounds(0.0, 0.0),)
    (square,) = ranges.bounds(made(values, found, "x * x"))
    assert (square.low, square.high) == (0.0, 1.0)
    (chosen,) = ranges.bounds(made(values, found, "k if p else x"))
    assert (chosen.low, chosen.high) == (-1.0, 300.0)
    (sure,) = ranges.bounds(made(values, found, "k + 2.0 > x", BOOL))
    assert (sure.low, sure.high) == (1.0, 1.0)
    (never,) = ranges.bounds(made(values, found, "k + 2.0 < x", BOOL))
    assert (never.low, never.high) == (0.0, 0.0)
    (open_,) = ranges.bounds(made(values, found, "k < x", BOOL))
    assert (open_.low, open_.high) == (0.0, 1.0)
