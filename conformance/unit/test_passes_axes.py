"""Products of vectors with constant zeros: what is left of them, term by term.

Plan. Vectors of every pattern of zeros, constants and variables meet each other in dot and cross.
  left    what is left is written down here, by hand, its terms in the order of the components
  value   in exact numbers it is the same, at random whole numbers
  stays   without a constant 0 nothing is taken apart
"""

from __future__ import annotations

import itertools
import random

import pytest

from codegen.ir import nodes as ir
from codegen.ir.types import F32, VEC2, VEC3, Vector
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.rules.axes import zero_components
from codegen.passes.rules.fold import constants
from codegen.passes.rules.identities import identities
from codegen.passes.rules.scalars import components
from codegen.passes.ssa.values import Values
from conformance.unit.support.plain import value_of

Part = str | float
Written = str | tuple[Part, ...]
"""A vector by its name, or its components: names of scalars and constants; one of them is all of them."""


def made() -> Values:
    values = Values()
    exact = identities(Ranges(values), frozenset({"exact", "finite"}))
    values.simplify_by((components, constants, exact, zero_components))
    return values


def vector(values: Values, written: Written, type_: Vector = VEC3) -> ir.Expr:
    if isinstance(written, str):
        return values.intern(ir.Var(type_, written))
    parts = (values.intern(ir.Var(F32, p)) if isinstance(p, str) else values.number(p, F32) for p in written)
    return values.build(ir.Construct(type_, tuple(parts)))


DOTS: list[tuple[Written, Written, str]] = [
    ("u", (0.0, 0.0, 1.0), "u.z"),
    ((0.0, 1.0, 0.0), "u", "u.y"),
    ("u", ("x", 0.0, "y"), "(u.x * x) + (u.z * y)"),
    (("x", "y", 0.0), "u", "(x * u.x) + (y * u.y)"),
    ((0.0, "x", "y"), ("z", "x", 0.0), "x * x"),
    ((0.0, 0.0, "x"), ("y", "z", 0.0), "0"),
    ((0.0, "x", "y"), ("z", 0.0, 0.0), "0"),
    ((0.0,), "u", "0"),
    ("u", (1.0, 2.0, 3.0), "dot(u, vec3(1, 2, 3))"),
    ("u", ("x",), "dot(u, vec3(x))"),
    (("x", "y", "z"), "u", "dot(vec3(x, y, z), u)"),
    ("u", "w", "dot(u, w)"),
]
CROSSES: list[tuple[Written, Written, str]] = [
    ("u", (0.0, 0.0, 1.0), "vec3(u.y, -u.x, 0)"),
    ((0.0, 0.0, 1.0), "u", "vec3(-u.y, u.x, 0)"),
    ("u", (1.0, 0.0, 0.0), "vec3(0, u.z, -u.y)"),
    ((0.0, "x", "y"), "u", "vec3((x * u.z) - (y * u.y), y * u.x, -(x * u.x))"),
    ("u", ("x", 0.0, "y"), "vec3(u.y * y, (u.z * x) - (u.x * y), -(u.y * x))"),
    ((0.0, 0.0, "x"), ("y", 0.0, 0.0), "vec3(0, x * y, 0)"),
    ((0.0,), "u", "vec3(0)"),
    ("u", (1.0, 2.0, 3.0), "cross(u, vec3(1, 2, 3))"),
    (("x", "y", "z"), "u", "cross(vec3(x, y, z), u)"),
    ("u", "w", "cross(u, w)"),
]


@pytest.mark.parametrize(("a", "b", "left"), DOTS)
def test_terms_of_a_dot_product_that_are_left(a: Written, b: Written, left: str) -> None:
    values = made()
    assert values.show(values.build(ir.Builtin(F32, "dot", (vector(values, a), vector(values, b))))) == left


@pytest.mark.parametrize(("a", "b", "left"), CROSSES)
def test_components_of_a_cross_product_that_are_left(a: Written, b: Written, left: str) -> None:
    values = made()
    assert (
        values.show(values.build(ir.Builtin(VEC3, "cross", (vector(values, a), vector(values, b))))) == left
    )


def test_two_components_have_a_dot_product_too() -> None:
    values = made()
    a, b = vector(values, (0.0, "x"), VEC2), vector(values, "v", VEC2)
    assert values.show(values.build(ir.Builtin(F32, "dot", (a, b)))) == "x * v.y"
    (step,) = [s for s in values.log if s.name == "axes"]
    assert step.what == "dot(vec2(0, x), v) -> x * v.y"
    assert step.why.startswith("finite: products with 0 are 0")


CHOICES: tuple[tuple[Part, ...], ...] = (0.0, 2.0, "x"), (0.0, "y"), (0.0, -1.0, "z")
PATTERNS: list[Written] = ["u", *itertools.product(*CHOICES)]


@pytest.mark.parametrize("op", ["dot", "cross"])
def test_every_pattern_of_zeros_keeps_the_value(op: str) -> None:
    chosen = random.Random(20_261)
    for a, b in itertools.product(PATTERNS, repeat=2):
        values = made()
        e = ir.Builtin(F32 if op == "dot" else VEC3, op, (vector(values, a), vector(values, b)))
        given = {name: chosen.randint(-9, 9) for name in "xyz"}
        point = {**given, "u": tuple(chosen.randint(-9, 9) for _ in range(3))}
        found = values.build(e)
        assert value_of(found, point) == value_of(e, point), (a, b, point)
        has_zero = any(isinstance(v, tuple) and 0.0 in v for v in (a, b))
        assert (op in values.show(found)) <= (not has_zero)
