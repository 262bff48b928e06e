"""Range analysis knows what can be known: of every kind of parameter, and of lengths of vectors.

Plan. (That no value leaves its range: test_passes_ranges.) Here ranges are as narrow as they can be.
  parameters  scalars, vectors, integers, truth values, arrays, with every kind of domain and without one
  lengths     sums, products, cross products, choices, constants, what is divided by its own length; where
              nothing is known, nothing is claimed
  products    of directions, and lengths as numbers; facts narrow lengths of sums
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.intervals.numbers import LARGEST
from codegen.intervals.values import Range
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Finite, Interval, Length, Unit
from codegen.ir.types import BOOL, F32, I32, U32, UVEC2, VEC2, VEC3, Scalar, Type, Vector, array_of
from codegen.passes.analysis import ranges
from codegen.passes.analysis.norms import Lengths
from codegen.passes.analysis.ranges import Bounds, Ranges
from codegen.passes.rules.scalars import components
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Values
from conformance.unit.support.tolerances import tolerance

WHOLE = (-(2**31), 2**31 - 1)
OPEN = (-math.inf, math.inf)
KINDS: dict[str, tuple[Scalar | Vector, Domain | None, tuple[float, float]]] = {
    "interval": (F32, Interval(0.25, 2.0), (0.25, 2.0)),
    "interval of components": (VEC3, Interval(-1.0, 2.0), (-1.0, 2.0)),
    "decimal ends": (F32, Interval(0.1, 0.7), (0.1, 0.7)),
    "one number": (F32, Interval(3.0, 3.0), (3.0, 3.0)),
    "denormal ends": (F32, Interval(1e-40, 1.0), (0.0, 1.0)),
    "denormal negative ends": (F32, Interval(-1.0, -1e-40), (-1.0, 0.0)),
    "finite": (F32, Finite(), (-LARGEST, LARGEST)),
    "anything": (F32, None, OPEN),
    "any vector": (VEC2, None, OPEN),
    "direction": (VEC3, Unit(), (-1.0, 1.0)),
    "length": (VEC3, Length(0.5, 3.0), (-3.0, 3.0)),
    "signed": (I32, Interval(-3.5, 2.5), (-3, 2)),
    "unsigned": (U32, Interval(0.0, 7.0), (0, 7)),
    "unsigned components": (UVEC2, Interval(2.0, 7.0), (2, 7)),
    "any signed": (I32, None, WHOLE),
    "any unsigned": (U32, None, (0, 2**32 - 1)),
    "finite signed": (I32, Finite(), WHOLE),
    "truth": (BOOL, None, (0.0, 1.0)),
}


@pytest.mark.parametrize("name", KINDS)
def test_parameter_lies_in_its_domain_and_no_more(name: str) -> None:
    type_, domain, (low, high) = KINDS[name]
    near = tolerance("range_of_cosines")
    for of in (type_, array_of(type_, 3)):
        values = Values(parameters={"x": ir.Parameter("x", of, domain)})
        x = values.intern(ir.Var(of, "x"))
        part = x if of == type_ else values.build(ir.Index(type_, x, values.number(1, I32)))
        found = Ranges(values).bounds(part)
        assert len(found) == (type_.size if isinstance(type_, Vector) else 1)
        for bound in found:
            assert bound.low == pytest.approx(low, rel=near)
            assert bound.high == pytest.approx(high, rel=near)
            assert bound.low <= low
            assert bound.high >= high
            assert bound.finite == math.isfinite(low)


def test_what_is_negated() -> None:
    values = Values(parameters={"x": ir.Parameter("x", F32, Interval(0.25, 2.0))})
    x = values.intern(ir.Var(F32, "x"))
    assert Ranges(values).bounds(values.build(ir.Unary(F32, "negate", x))) == (Bounds(-2.0, -0.25),)
    low, high, nothing = np.array([1.0]), np.array([2.0]), np.array([0])
    assert ranges._ends(Range(low, high, nothing)) == (1.0, 2.0)
    assert ranges._ends(Range(low, high, nothing + 1)) == OPEN


def test_numbers_of_a_loop_and_of_calls() -> None:
    values = Values(indices={"i@1": (2, 5)})
    index = values.intern(ir.Var(I32, "i@1"))
    ranges = Ranges(values)
    assert ranges.bounds(index) == (Bounds(2.0, 5.0),)
    assert ranges.bounds(values.binary("+", index, index)) == (Bounds(4.0, 10.0),)
    assert ranges.bounds(values.build(ir.Convert(F32, index))) == (Bounds(2.0, 5.0),)
    call = values.build(ir.Call(F32, "somewhere", (index,)))
    assert not ranges.bounds(call)[0].finite
    number = values.build(ir.Call(U32, "elsewhere", (index,)))
    assert ranges.bounds(number) == (Bounds(0.0, 2.0**32 - 1.0),)


def test_bounds_are_shown_short() -> None:
    assert str(Bounds(1.0 / 3.0, 2.0)) == "[0.333333, 2]"


PARAMETERS: dict[str, tuple[Type, Domain | None]] = {
    **{name: (VEC3, Unit()) for name in "ut"},
    **{name: (VEC3, Length(0.0, 3.0)) for name in "wz"},
    "v": (VEC3, Finite()),
    "b": (VEC3, Interval(-1.0, 2.0)),
    "s": (F32, Interval(0.5, 2.0)),
    "r": (F32, Interval(-2.0, 1.0)),
    "p": (BOOL, None),
}


def known() -> tuple[Values, Ranges, dict[str, ir.Expr]]:
    parameters = {n: ir.Parameter(n, t, d) for n, (t, d) in PARAMETERS.items()}
    values = Values(rules=(components,), parameters=parameters)
    return values, Ranges(values), {n: values.intern(ir.Var(t, n)) for n, (t, _) in PARAMETERS.items()}


def made(values: Values, found: dict[str, ir.Expr], text: str, type_: Type = VEC3) -> ir.Expr:
    return patterns.make(patterns.parse(text), found, values, type_)


LENGTHS = {
    "u": (1.0, 1.0),
    "-u": (1.0, 1.0),
    "normalize(v)": (1.0, 1.0),
    "w": (0.0, 3.0),
    "-w": (0.0, 3.0),
    "v": (0.0, math.inf),
    "b": (0.0, math.inf),
    "u * 3.0": (3.0, 3.0),
    "3.0 * u": (3.0, 3.0),
    "u * s": (0.5, 2.0),
    "u * r": (0.0, 2.0),
    "u * -s": (0.5, 2.0),
    "u / s": (0.5, 2.0),
    "u / 4.0": (0.25, 0.25),
    "u / r": (0.0, math.inf),
    "v * s": (0.0, math.inf),
    "u * t": (0.0, math.inf),
    "u + 0.25 * t": (0.75, 1.25),
    "u - 0.25 * t": (0.75, 1.25),
    "0.25 * u - t": (0.75, 1.25),
    "u + w": (0.0, 4.0),
    "w - z": (0.0, 6.0),
    "u + v": (0.0, math.inf),
    "b + u": (0.0, 1.0 + math.sqrt(12.0)),
    "cross(u, 2.0 * t)": (0.0, 2.0),
    "cross(w, z)": (0.0, 9.0),
    "cross(u - t, u + t)": (0.0, 2.0),
    "cross(u - t, t + u)": (0.0, 2.0),
    "cross(u - t, u + w)": (0.0, 8.0),
    "cross(w - u, u + w)": (0.0, 6.0),
    "u if p else 3.0 * t": (1.0, 3.0),
    "3.0 * u if p else t": (1.0, 3.0),
    "inverse_sqrt(dot(v, v)) * v": (0.0, math.inf),
    "inverse_sqrt(max(dot(v, v), 1.0e-30)) * v": (0.0, 1.0),
    "inverse_sqrt(max(dot(b, b), 1.0e-30)) * b": (0.0, 1.0),
    "inverse_sqrt(max(1.0e-30, dot(b, b))) * b": (0.0, 1.0),
    "inverse_sqrt(max(dot(v, v), 1.0e-42)) * v": (0.0, math.inf),
    "inverse_sqrt(dot(v, w)) * v": (0.0, math.inf),
    "inverse_sqrt(dot(w, w)) * v": (0.0, math.inf),
}


@pytest.mark.parametrize("text", LENGTHS)
def test_length_is_known_and_no_more(text: str) -> None:
    values, ranges, given = known()
    least, most = Lengths(values, ranges.bounds).of(made(values, given, text))
    low, high = LENGTHS[text]
    near = tolerance("range_of_lengths")
    assert least == pytest.approx(low, abs=near)
    if math.isinf(high):
        assert most > LARGEST / 4.0
    else:
        assert most == pytest.approx(high, abs=near * max(1.0, high))
        assert most >= high
    assert least <= low


def cross_parts(values: Values, a: ir.Expr, b: ir.Expr, order: tuple[tuple[int, int], ...]) -> ir.Expr:
    parts = []
    for i, j in order:
        left = values.binary("*", values.component(a, i), values.component(b, j))
        right = values.binary("*", values.component(a, j), values.component(b, i))
        parts.append(values.binary("-", left, right))
    return values.build(ir.Construct(VEC3, tuple(parts)))


def test_cross_product_that_is_written_out_is_one() -> None:
    values, ranges, given = known()
    lengths = Lengths(values, ranges.bounds)
    rows = ((1, 2), (2, 0), (0, 1))
    u, t, v = given["u"], given["t"], given["v"]
    assert lengths.of(cross_parts(values, u, t, rows))[1] == pytest.approx(1.0, abs=tolerance("length_bound"))
    for order in (((1, 2), (0, 2), (0, 1)), ((1, 2), (1, 2), (0, 1)), ((1, 2), (2, 0), (0, 2))):
        assert math.isinf(lengths.of(cross_parts(values, u, t, order))[1])
    assert (
        math.isinf(lengths.of(cross_parts(values, u, v, rows))[1])
        or lengths.of(cross_parts(values, u, v, rows))[1] > 1e30
    )
    mixed = [cross_parts(values, *pair, rows) for pair in ((u, t), (t, u))]
    parts = tuple(values.component(mixed[k % 2], k) for k in range(3))
    assert math.isinf(lengths.of(values.build(ir.Construct(VEC3, parts)))[1])


def test_lengths_of_constants_and_arrays() -> None:
    values, ranges, given = known()
    lengths = Lengths(values, ranges.bounds)
    three_four = values.build(ir.Construct(VEC3, tuple(values.number(x, F32) for x in (3.0, 4.0, 0.0))))
    assert lengths.of(three_four) == pytest.approx((5.0, 5.0), abs=tolerance("length_bound"))
    assert lengths.of(values.number(2.0, VEC3)) == pytest.approx(
        (math.sqrt(12.0),) * 2, abs=tolerance("length_bound")
    )
    u, w = given["u"], given["w"]
    three = made(values, given, "u * 3.0")
    array = values.build(ir.Construct(array_of(VEC3, 3), (u, three, w)))
    element = values.build(ir.Index(VEC3, array, values.intern(ir.Var(I32, "k"))))
    assert lengths.of(element) == pytest.approx((0.0, 3.0), abs=tolerance("length_bound"))
    units = values.build(ir.Construct(array_of(VEC3, 2), (u, given["t"])))
    element = values.build(ir.Index(VEC3, units, values.intern(ir.Var(I32, "k"))))
    assert lengths.of(element) == pytest.approx((1.0, 1.0), abs=tolerance("length_bound"))
    assert lengths.of(given["s"]) == (0.0, math.inf)


PRODUCTS = {
    "dot(u, t)": (-1.0, 1.0),
    "dot(u, u)": (1.0, 1.0),
    "dot(w, w)": (0.0, 9.0),
    "dot(w, z)": (-9.0, 9.0),
    "dot(u, 2.0 * t)": (-2.0, 2.0),
    "length(w)": (0.0, 3.0),
    "length(u)": (1.0, 1.0),
    "length(u + 0.25 * t)": (0.75, 1.25),
    "length(b)": (0.0, math.sqrt(12.0)),
    "dot(b, b)": (0.0, 12.0),
}


@pytest.mark.parametrize("text", PRODUCTS)
def test_product_is_known_and_no_more(text: str) -> None:
    values, ranges, given = known()
    (bound,) = ranges.bounds(made(values, given, text, F32))
    low, high = PRODUCTS[text]
    near = tolerance("range_of_lengths") * max(1.0, high)
    assert (bound.low, bound.high) == pytest.approx((low, high), abs=near)
    assert bound.low <= low
    assert bound.high >= high


@pytest.mark.parametrize(("text", "sign"), [("u + t", 1.0), ("u - t", -1.0), ("t - u", -1.0)])
def test_fact_of_a_cosine_narrows_the_sum(text: str, sign: float) -> None:
    values, ranges, given = known()
    ranges.add_fact(made(values, given, "dot(t, u)", F32), 0.5, 0.625)
    least, most = Lengths(values, ranges.bounds).of(made(values, given, text))
    ends = sorted(math.sqrt(2.0 + 2.0 * sign * c) for c in (0.5, 0.625))
    assert (least, most) == pytest.approx(ends, abs=tolerance("range_of_lengths"))


def test_fact_outside_what_can_be_is_told_with_both() -> None:
    values, ranges, given = known()
    ranges.add_fact(made(values, given, "dot(w, u)", F32), 3.5, 4.0)
    with pytest.raises(
        UserError, match=r'^fact "dot\(w, u\)" in \[3\.49999, 4\.00001\] contradicts the ranges'
    ):
        ranges.check_facts()
