"""Sums whose terms cancel, one at a time: what is left, written down by hand, and the same in exact numbers.

Plan.
  left    the text of what is left: terms in order of first sight, positive ones first, scalars before vectors
  value   the same in exact numbers, at random fractions
  limits  how deep sums are looked at, and up to how many terms; one more, and they stay as they are
  stays   what does not cancel, is not shorter, or would need a number that is no float32
"""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from codegen.intervals.numbers import LARGEST
from codegen.ir import nodes as ir
from codegen.ir.types import F32, U32, VEC2, VEC3, Type
from codegen.passes.rules.sums import cancellation
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Values
from conformance.unit.support.plain import value_of

SCALARS = "abcdefghijkrs"
VECTORS = "uvw"
BIG = float(LARGEST)


def expression(values: Values, text: str, type_: Type = F32) -> ir.Expr:
    found: dict[str, ir.Expr] = {name: values.intern(ir.Var(F32, name)) for name in SCALARS}
    found |= {name: values.intern(ir.Var(VEC3, name)) for name in VECTORS}
    found |= {name: values.intern(ir.Var(U32, name)) for name in "mn"}
    return patterns.make(patterns.parse(text), found, values, type_)


def point(seed: int) -> dict[str, object]:
    drawn = random.Random(seed)

    def number() -> Fraction:
        return Fraction(drawn.randint(-99, 99), drawn.randint(1, 9))

    return {**{n: number() for n in SCALARS}, **{n: (number(), number(), number()) for n in VECTORS}}


def deep(inner: str, times: int, left: bool = False) -> str:
    """A sum of so many sums inside each other."""
    for name in "abcdefg"[:times]:
        inner = f"({inner} + {name})" if left else f"({name} + {inner})"
    return inner


COUNTED = "(1.0 + (2.0 + (3.0 + (4.0 + k))))"
DEEPER = "(1.0 + (2.0 + (3.0 + (4.0 + (5.0 + k)))))"
FOUR = "((e + f) + (g + h))"
LEFT: dict[str, str] = {
    "(r + k) - k": "r",
    "(r + k) - r": "k",
    "k - (r + k)": "-r",
    "(r - k) + k": "r",
    "-(r + k) + r": "-k",
    "-(r - k) + r": "k",
    "(r - k) - (r + k)": "-(2 * k)",
    "(k + r) + (r - k)": "2 * r",
    "(r * k + s) - k * r": "s",
    "(r + k) * 0.5 - k * 0.5": "0.5 * r",
    "((1.0 + k) * r) + ((1.0 - k) * r)": "2 * r",
    "((r + k) + 1.0) - k": "r + 1",
    "((r + k) + (s + 1.0)) - k": "(r + s) + 1",
    "((k - 1.0) + r) - k": "r - 1",
    "((k - r) + s) - k": "s - r",
    "((k - r) - s) - k": "-r - s",
    "(0.5 * r + (2.0 * s + k)) - k": "(0.5 * r) + (2 * s)",
    "(0.5 * s + (k - 2.0 * r)) - k": "(0.5 * s) - (2 * r)",
    "(r * s * 3.0 + k) - k": "(3 * r) * s",
    "(s * r + k) - k": "s * r",
    "((r + k) * (r + k) - k * k) - 2.0 * r * k": "r * r",
    "r * k + (k * (r * -2.0) + r * k)": "0",
    "abs(r + k) * (k + 1.0) - abs(r + k) * k": "abs(r + k)",
    deep("k", 5) + " - k": "(((e + d) + c) + b) + a",
    deep("k", 5, left=True) + " - k": "(((a + b) + c) + d) + e",
    "k + " + deep("(r - k)", 4): "(((d + c) + b) + a) + r",
    deep("(r - k)", 4, left=True) + " + k": "(((r + a) + b) + c) + d",
    f"r * {COUNTED} - r * k": "10 * r",
    f"{COUNTED} * r - k * r": "10 * r",
    f"-{COUNTED} + k": "-10",
    "2.0 * r + " + deep("(r * -2.0)", 4): "((d + c) + b) + a",
    "((r + k) * (r + k) - k * k) + r * r": "((2 * r) * r) + ((2 * r) * k)",
    "r * r + ((r + k) * (r + k) - k * k)": "((2 * r) * r) + ((2 * r) * k)",
    "0.5 * ((r + k) * (r + k) - k * k) + r * r": "((1.5 * r) * r) + (r * k)",
    "((r + k) * (r + k) - k * k) * 0.5 + r * r": "((1.5 * r) * r) + (r * k)",
    "-((r + k) * (r + k) - k * k) + 3.0 * r * r": "((2 * r) * r) - ((2 * r) * k)",
    f"(((a + b) + (c + d)) * {FOUR}) - ((a * {FOUR} + b * {FOUR}) + (c * {FOUR} + d * {FOUR}))": "0",
}
LEFT_OF_VECTORS: dict[str, str] = {
    "(u + v) - v": "u",
    "(u - v) + (v + u)": "2 * u",
    "(r * u + v) - u * r": "v",
    "u * (r + 1.0) - u * r": "u",
    "(u * r * s + v) - v": "(r * s) * u",
    "(v + (u * r) * 2.0) - v": "(2 * r) * u",
    "(u - v) - u": "-v",
    "(u + v) - (u + v)": "vec3(0)",
}


@pytest.mark.parametrize("text", [*LEFT, *LEFT_OF_VECTORS])
def test_what_is_left_of_a_sum(text: str) -> None:
    type_ = F32 if text in LEFT else VEC3
    values = Values(rules=(cancellation(),))
    plain = expression(Values(), text, type_)
    found = expression(values, text, type_)
    steps = [s for s in values.log if s.name == "sums"]
    assert steps
    assert all(s.why.startswith("real: terms cancel exactly") for s in steps)
    shown = values.show(found)
    assert shown == (LEFT | LEFT_OF_VECTORS)[text] or "..." in shown
    for seed in range(3):
        assert value_of(found, point(seed)) == value_of(plain, point(seed))


SIX = "((e + f) + (g + h) + (i + j))"
MANY = f"((a + b + c) * {SIX})"
STAYS: tuple[str, ...] = (
    *("r + k", "r - k", "(r + k) + r", "(r + k) - s", "r * k - k", "-r + k", "(r + 4.0) - 4.0"),
    "(r + k) * (r - k)",
    "(m + n) - n",
    "(r + s * 0.0) - k",
    "(r + k) * (r + k) - k * k",
    "(0.1 * r + 0.2 * r + k) - k",
    "(0.75 * (3.0e38 * r + 3.0e38 * r) + k) - k",
    f"({BIG!r} * r + {BIG!r} * r + k) - k",
    "(3.0e38 * r * 3.0e38 * 3.0e38 + k) - k",
    f"({2.0**-100!r} * r * {2.0**-30!r} + k) - k",
    "(1.0e-30 * r * 1.0e-30 + k) - k",
    deep("k", 6) + " - k",
    deep("k", 6, left=True) + " - k",
    f"r * {DEEPER} - r * k",
    f"{DEEPER} * r - k * r",
    f"-{DEEPER} + k",
    f"(((a + b) + (c + d)) * {FOUR} + i) - ((a * {FOUR} + b * {FOUR}) + (c * {FOUR} + d * {FOUR}))",
    f"{MANY} - (a * {SIX} + b * {SIX} + c * {SIX})",
    f"({MANY} + r) - r",
    f"(r + {MANY}) - r",
    f"r - (r + {MANY})",
    f"r + -{MANY}",
    f"({MANY} * s + r) - r",
    f"(s * {MANY} + r) - r",
    f"((((a + b) + (c + d)) * {FOUR}) + i) - i",
)


@pytest.mark.parametrize("text", STAYS)
def test_other_sums_stay(text: str) -> None:
    values = Values(rules=(cancellation(),))
    integers = "m" in text
    plain = Values()
    type_ = U32 if integers else F32
    assert values.show(expression(values, text, type_)) == plain.show(expression(plain, text, type_))
    assert not values.log


def test_as_many_terms_as_may_be() -> None:
    """15 products and one more term; with two more there are too many."""
    fifteen = "((a + b + c) * ((e + f) + (g + h) + j))"
    for text, cancels in ((f"({fifteen} + i) - i", True), (f"(({fifteen} + i) + k) - (i + k)", False)):
        values = Values(rules=(cancellation(),))
        found = expression(values, text)
        assert value_of(found, point(5)) == value_of(expression(Values(), text), point(5))
        looked = [s for s in values.log if s.name == "sums"]
        if not cancels:
            assert not looked


def test_products_with_constant_vectors_cancel() -> None:
    for parts in ((0.5, 0.5), (0.5, 0.25)):
        values = Values(rules=(cancellation(),))
        v, w = (values.intern(ir.Var(VEC2, name)) for name in "vw")
        constant = values.build(ir.Construct(VEC2, tuple(values.number(x, F32) for x in parts)))
        product = values.binary("*", w, constant)
        found = values.binary("-", values.binary("+", v, product), product)
        assert found is v
        kept = values.binary("-", values.binary("+", values.binary("+", v, product), w), w)
        at: dict[str, object] = {"v": (Fraction(1), Fraction(2)), "w": (Fraction(3), Fraction(5))}
        assert value_of(kept, at) == (1 + 3 * Fraction(parts[0]), 2 + 5 * Fraction(parts[1]))


def test_constants_never_cancel() -> None:
    """(v + c) - c may be there to round v, whether the components of c are one number or not."""
    values = Values(rules=(cancellation(),))
    v = values.intern(ir.Var(VEC2, "v"))
    for parts in ((0.5, 0.5), (0.5, 0.25)):
        constant = values.build(ir.Construct(VEC2, tuple(values.number(x, F32) for x in parts)))
        values.binary("-", values.binary("+", v, constant), constant)
    assert not values.log
