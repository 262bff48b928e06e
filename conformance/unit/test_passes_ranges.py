"""Range analysis is sound: no value of any subexpression leaves its range, on any input.

Plan. A function is taken apart into its values without simplifying anything; a probe returns all of them at
once, evaluated in float32 at random points, at the ends of the domains and at the families of hard cases.
Every one lies in its range. Facts narrow what they speak of, and only that; what nothing is known of has no
range. By default a sample of the functions, all of them nightly.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import TABLES, permitted
from codegen.ir import nodes as ir
from codegen.ir.domains import Edges, Interval, Length, Unit
from codegen.ir.types import BOOL, F32, I32, TEXTURE, VEC2, VEC3, VEC4, Field, Struct, array_of
from codegen.library import load_library
from codegen.passes.analysis.norms import Lengths
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.analysis.transfer import transfers
from codegen.passes.inline import Inliner, joined
from codegen.passes.placement.regions import place
from codegen.passes.rules.scalars import components
from codegen.passes.specialise import specialise
from codegen.passes.ssa.values import Values
from codegen.passes.subject import Fact, Subject
from conformance.cases.drawing import draw, families_for
from conformance.unit.support.tolerances import tolerance

LIBRARY = load_library()
LANES = 600
SEED = 20261122
FACT = 0.3
"""Least cosine between two directions that a fact states."""
NAMES = sorted(LIBRARY.public)
SAMPLE = sorted({"fakefur_shade", "safe_normalize", "pcg_hash", "latlong_uv", "brushed_shade", *NAMES[::16]})
"""Directions, guards, integers, angles, and one of every sixteen."""


def probe(name: str) -> tuple[Values, list[ir.Expr], ir.Function]:
    """The values of a function, unsimplified, and a function that returns them all."""
    function = LIBRARY.function(name)
    values = Values(rules=(components,))
    subject = Subject(function)
    flow = Inliner(LIBRARY, values, (), 8).flow(function, subject.arguments(values))
    order = place(flow, joined(values, function.returns, flow.result)).order[::-1]
    wanted = [e for e in order if not isinstance(e.type, Struct) and ir.children(e)]
    names = {id(e): f"part{k}" for k, e in enumerate(wanted)}

    def text(e: ir.Expr) -> ir.Expr:
        parts = (ir.Var(c.type, names[id(c)]) if id(c) in names else text(c) for c in ir.children(e))
        return (
            ir.Var(e.type, e.name.replace(".", "_")) if isinstance(e, ir.Var) else ir.rebuild(e, tuple(parts))
        )

    shape = Struct("Parts", tuple(Field(names[id(e)], e.type) for e in wanted))
    body = [ir.Let(names[id(e)], text(e)) for e in wanted]
    result = ir.Construct(shape, tuple(ir.Var(e.type, names[id(e)]) for e in wanted))
    parameters = tuple(replace(p, name=path.replace(".", "_")) for path, p in values.parameters.items())
    made = replace(
        function, name="probe", parameters=parameters, returns=shape, body=(*body, ir.Return(result))
    )
    return values, wanted, made


def flat(inputs: dict[str, object], path: str = "") -> dict[str, object]:
    found: dict[str, object] = {}
    for name, value in inputs.items():
        if isinstance(value, dict):
            found |= flat(value, f"{path}{name}_")
        else:
            found[f"{path}{name}"] = value
    return found


def directions(name: str) -> tuple[str, ...]:
    """The function's first two directions."""
    found = [p.name for p in LIBRARY.function(name).parameters if isinstance(p.domain, Unit)]
    return tuple(found[:2]) if len(found) > 1 else ()


def facing(name: str, inputs: dict[str, Any]) -> Any:
    """Mask of the inputs whose first two directions keep the fact."""
    a, b = (np.asarray(inputs[path], np.float64) for path in directions(name))
    return np.einsum("nk,nk->n", a, b) >= FACT


def check(name: str, *, with_fact: bool = False) -> None:
    values, wanted, made = probe(name)
    ranges = Ranges(values)
    if with_fact:
        fact = Fact(f"dot({', '.join(directions(name))})", FACT)
        ranges.add_fact(*Subject(LIBRARY.function(name)).fact(values, fact))
    library = LIBRARY.with_functions([made])
    narrow = 0
    for family in [*families_for(LIBRARY.function(name).parameters), "uniform"]:
        inputs = draw(LIBRARY.function(name), family, LANES, SEED)
        got = evaluate(library, "probe", flat(inputs), "float32")
        assert isinstance(got, dict)
        keeps = facing(name, inputs) if with_fact else np.ones(LANES, np.bool_)
        for e, value in zip(wanted, got.values(), strict=True):
            columns = np.asarray(value, np.float64).reshape(LANES, -1).T
            for bound, column in zip(ranges.bounds(e), columns, strict=True):
                narrow += bound.finite
                outside = ~((column >= bound.low) & (column <= bound.high)) & keeps
                assert not outside.any() or not bound.finite, (
                    f"{name}, {family}, seed {SEED}: {values.show(e)} = {column[outside][0]} outside {bound}"
                )
    assert narrow or not wanted


@pytest.mark.parametrize("name", SAMPLE)
def test_no_value_leaves_its_range(name: str) -> None:
    check(name)


@pytest.mark.parametrize("name", [name for name in SAMPLE if directions(name)])
def test_no_value_leaves_its_range_where_a_fact_holds(name: str) -> None:
    check(name, with_fact=True)


@pytest.mark.nightly
@pytest.mark.parametrize("name", [name for name in NAMES if directions(name)])
def test_no_value_leaves_its_range_in_any_function_where_a_fact_holds(name: str) -> None:
    check(name, with_fact=True)


@pytest.mark.nightly
@pytest.mark.parametrize("name", NAMES)
def test_no_value_leaves_its_range_in_any_function(name: str) -> None:
    check(name)


def known(**domains: tuple[float, float]) -> tuple[Values, Ranges, dict[str, ir.Expr]]:
    """Float parameters with ranges, as values."""
    parameters = tuple(ir.Parameter(n, F32, Interval(*ends)) for n, ends in domains.items())
    values = Values(parameters={p.name: p for p in parameters})
    return values, Ranges(values), {p.name: values.intern(ir.Var(F32, p.name)) for p in parameters}


def test_product_with_itself_is_a_square() -> None:
    values, ranges, given = known(x=(-2.0, 3.0), y=(-2.0, 3.0))
    square = values.binary("*", given["x"], given["x"])
    other = values.binary("*", given["x"], given["y"])
    assert ranges.bounds(square)[0].low == 0.0
    assert ranges.bounds(other)[0].low == pytest.approx(-6.0, rel=tolerance("range_of_products"))


def test_division_by_what_may_be_zero_has_no_range() -> None:
    values, ranges, given = known(x=(1.0, 2.0), y=(0.0, 3.0))
    assert not ranges.bounds(values.binary("/", given["x"], given["y"]))[0].finite


def test_directions_know_their_length() -> None:
    function = LIBRARY.function("sin_angle")
    values = Values()
    Subject(function).arguments(values)
    a, b = (values.intern(ir.Var(VEC3, p.name)) for p in function.parameters)
    ranges = Ranges(values)
    dot = values.build(ir.Builtin(F32, "dot", (a, b)))
    assert ranges.bounds(dot)[0].high == pytest.approx(1.0, abs=tolerance("range_of_cosines"))
    across = values.build(ir.Builtin(VEC3, "cross", (values.binary("-", a, b), values.binary("+", a, b))))
    lengths = Lengths(values, ranges.bounds)
    assert lengths.of(across)[1] == pytest.approx(2.0, abs=tolerance("range_of_lengths"))
    leaning = values.binary("+", a, values.binary("*", values.number(0.1, F32), b))
    assert lengths.of(leaning) == pytest.approx((0.9, 1.1), abs=tolerance("range_of_lengths"))
    square = values.build(ir.Builtin(F32, "dot", (leaning, leaning)))
    assert ranges.bounds(square)[0].low == pytest.approx(0.81, abs=tolerance("range_of_squares"))
    factor = values.build(ir.Builtin(F32, "inverse_sqrt", (square,)))
    assert lengths.of(values.binary("*", factor, leaning))[1] == pytest.approx(
        1.0, abs=tolerance("range_of_cosines")
    )
    assert math.isinf(lengths.of(values.build(ir.Construct(VEC3, (dot,))))[1])


def test_lengths_say_nothing_of_what_may_overflow() -> None:
    """Lengths up to 1e30 bound a product by 1e60, which single precision does not reach."""
    values = Values(parameters={"v": ir.Parameter("v", VEC3, Length(1e-30, 1e30))})
    v = values.intern(ir.Var(VEC3, "v"))
    ranges = Ranges(values)
    assert not ranges.bounds(values.build(ir.Builtin(F32, "dot", (v, v))))[0].finite
    assert ranges.bounds(v)[0].finite


def test_fact_narrows_either_order_and_nothing_else() -> None:
    function = LIBRARY.function("sin_angle")
    values = Values()
    subject = Subject(function)
    subject.arguments(values)
    first, second = (p.name for p in function.parameters)
    ranges = Ranges(values)
    ranges.add_fact(*subject.fact(values, Fact(f"dot({second}, {first})", 0.25)))
    a, b = (values.intern(ir.Var(VEC3, name)) for name in (first, second))
    assert ranges.bounds(values.build(ir.Builtin(F32, "dot", (a, b))))[0].low == pytest.approx(
        0.25, abs=tolerance("range_of_cosines")
    )
    assert ranges.bounds(values.build(ir.Builtin(F32, "dot", (values.negative(a), b))))[0].low < -0.9


def test_truth_value_of_a_decided_comparison() -> None:
    values, ranges, given = known(x=(1.0, 2.0), y=(2.5, 3.0))
    (decided,) = ranges.bounds(values.binary("<", given["x"], given["y"], BOOL))
    assert (decided.low, decided.high) == (1.0, 1.0)


def test_range_of_one_number_holds_what_every_table_permits() -> None:
    values, ranges, given = known(x=(7.5, 7.5))
    power = values.build(ir.Builtin(F32, "exp", (given["x"],)))
    body = (ir.Return(ir.Builtin(F32, "exp", (ir.Var(F32, "x"),))),)
    parameters = (ir.Parameter("x", F32, None),)
    f = replace(LIBRARY.function("safe_sqrt"), name="probe", parameters=parameters, body=body)
    library = LIBRARY.with_functions([f])
    found = [permitted(library, "probe", {"x": [7.5]}, table) for table in TABLES]
    low = [float(np.ravel(p.low)[0]) for p in found if not isinstance(p.low, dict)]
    high = [float(np.ravel(p.high)[0]) for p in found if not isinstance(p.high, dict)]
    (bound,) = ranges.bounds(power)
    assert (bound.low, bound.high) == (min(low), max(high))
    assert len(set(low)) > 1


@pytest.mark.parametrize("e", [ir.Const(F32, 1.0), ir.Var(F32, "x"), ir.Call(F32, "f", ())], ids=repr)
def test_leaves_and_calls_are_no_operations(e: ir.Expr) -> None:
    for transfer in transfers():
        with pytest.raises(TypeError, match=type(e).__name__):
            transfer.computed(e, ())


def test_elements_of_an_array_are_not_one_value() -> None:
    array = array_of(F32, 3)
    values = Values(parameters={"a": ir.Parameter("a", array, Interval(0.0, 1.0))})
    whole = values.intern(ir.Var(array, "a"))
    first, second = (values.build(ir.Index(F32, whole, values.number(k, I32))) for k in (0, 1))
    ranges = Ranges(values)
    assert ranges.bounds(values.binary("-", first, second))[0].low == -1.0
    assert ranges.bounds(values.binary("-", first, first))[0].high == 0.0


def test_of_what_maps_hold_nothing_is_known() -> None:
    values = Values(parameters={"m": ir.Parameter("m", TEXTURE, Edges("clamp", "clamp"))})
    of_map = values.intern(ir.Var(TEXTURE, "m"))
    size = values.build(ir.Builtin(VEC2, "texture_size", (of_map,)))
    ranges = Ranges(values)
    for e, count in ((size, 2), (values.build(ir.Builtin(VEC4, "lookup", (of_map, size))), 4)):
        assert [bound.finite for bound in ranges.bounds(e)] == [False] * count
    assert specialise(LIBRARY, "env_grid_blinn_phong").function.reads_textures
