"""Lengths of vectors, over ranges that are given: each rule at numbers worked out by hand, with its room.

Plan. u and t are unit vectors, w and z no longer than 3, of v nothing is known; a b c d are constants.
  units    what is a unit vector, and what only looks like one
  lengths  hold the exact ends, strictly where something is rounded, and no more than a little
  factors  a vector times or over a number of every sign; over its own length, with and without a guard
  room     the slacks cover what the tables permit (codegen.intervals.tables), component by component
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Finite, Length, Unit
from codegen.ir.types import BOOL, F32, I32, VEC2, VEC3, Type, array_of
from codegen.passes.analysis import norms
from codegen.passes.analysis.norms import Bounded, Lengths, is_unit
from codegen.passes.analysis.ranges import Bounds
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Values, constant_components
from conformance.unit.support.tolerances import tolerance

STEP = 2.0**-23
"""Relative distance of float32 neighbours."""
UNIT = 1e-6
"""How far the length of a unit vector of the cases may be from 1."""
ARRAY = array_of(VEC3, 2)
PARAMETERS: dict[str, tuple[Type, Domain | None]] = {
    **{name: (VEC3, Unit()) for name in "ut"},
    **{name: (VEC3, Length(0.0, 3.0)) for name in "wz"},
    "long": (VEC3, Length(0.0, 100.0)),
    "v": (VEC3, Finite()),
    **{name: (F32, None) for name in ("s", "r", "g", "one", "zero", "tiny", "up")},
    "p": (BOOL, None),
    "us": (ARRAY, Unit()),
    "vs": (ARRAY, Finite()),
    "i": (I32, None),
}
CONSTANTS = {
    "a": (3.0, 4.0, 0.0),
    "b": (0.0, 0.0, 12.0),
    "c": (0.0, 0.6, 0.8),
    "d": (-6.0, -8.0, 0.0),
    "o": (0.0, 0.0, 0.0),
}
GIVEN = {
    "s": (0.5, 2.0),
    "r": (-2.0, 1.0),
    "g": (-4.0, -2.0),
    "one": (1.0, 1.0),
    "zero": (0.0, 0.0),
    "tiny": (2.0**-125, 2.0**-125),
    "up": (2.0, math.inf),
    "dot(u, t)": (0.5, 0.625),
    "dot(vec3(3, 4, 0), vec3(0, 0, 12))": (0.0, 0.0),
    "dot(vec3(3, 4, 0), vec3(-6, -8, 0))": (-50.0, -50.0),
    "dot(w, z)": (-40.0, -30.0),
    "dot(u, vec3(0, 0.6, 0.8))": (0.96875, 1.0),
}


def made() -> tuple[Values, Lengths, dict[str, ir.Expr]]:
    parameters = {n: ir.Parameter(n, t, d) for n, (t, d) in PARAMETERS.items()}
    values = Values(parameters=parameters)

    def bounds(e: ir.Expr) -> Sequence[Bounded]:
        numbers = constant_components(e)
        if numbers is not None:
            return [Bounds(float(x), float(x)) for x in numbers]
        default = (-2.0, 0.5) if values.show(e) == "long.xyz" else (-math.inf, math.inf)
        return [Bounds(*GIVEN.get(values.show(e), default))] * (3 if e.type == VEC3 else 1)

    found: dict[str, ir.Expr] = {n: values.intern(ir.Var(t, n)) for n, (t, _) in PARAMETERS.items()}
    for name, numbers in CONSTANTS.items():
        found[name] = values.build(ir.Construct(VEC3, tuple(values.number(x, F32) for x in numbers)))
    found["box"] = values.build(ir.Swizzle(VEC3, found["long"], "xyz"))
    return values, Lengths(values, bounds), found


def expression(values: Values, found: dict[str, ir.Expr], text: str, type_: Type = VEC3) -> ir.Expr:
    return patterns.make(patterns.parse(text), found, values, type_)


UNITS: dict[str, bool] = {
    "u": True, "v": False, "w": False, "-u": True, "-v": False, "normalize(v)": True, "cross(u, t)": False,
    "u if p else t": True, "u if p else v": False, "v if p else u": False, "u + t": False, "c": True,
    "a": False, "-c": True,
}  # fmt: skip


@pytest.mark.parametrize("text", UNITS)
def test_unit_vectors(text: str) -> None:
    values, _, found = made()
    assert is_unit(values, expression(values, found, text)) == UNITS[text]


def test_unit_vectors_of_arrays_constants_and_strangers() -> None:
    values, _, found = made()
    for parts, expected in ((("u", "t"), True), (("u", "v"), False), (("v", "u"), False)):
        array = values.intern(ir.Construct(ARRAY, tuple(found[p] for p in parts)))
        assert is_unit(values, array) == expected
        assert is_unit(values, values.intern(ir.Index(VEC3, array, found["i"]))) == expected
    assert is_unit(values, values.intern(ir.Index(VEC3, found["us"], found["i"])))
    assert not is_unit(values, values.intern(ir.Index(VEC3, found["vs"], found["i"])))
    assert not is_unit(values, values.intern(ir.Var(VEC3, "nobody")))
    assert not is_unit(values, values.number(1.0, F32))
    assert not is_unit(values, values.number(1.0, VEC3))
    for z, expected in ((1.0e-3, True), (1.8e-3, False)):  # longer by z^2 / 2
        near = tuple(values.number(x, F32) for x in (1.0, 0.0, z))
        assert is_unit(values, values.build(ir.Construct(VEC3, near))) == expected
    short = tuple(values.number(x, F32) for x in (0.999, 0.0))
    assert not is_unit(values, values.build(ir.Construct(VEC2, short)))


EXACT: dict[str, tuple[float, float]] = {
    "a": (5.0, 5.0),
    "-a": (5.0, 5.0),
    "w": (0.0, 3.0),
    "-w": (0.0, 3.0),
    "u": (1.0, 1.0),
    "-u": (1.0, 1.0),
    "box": (0.0, math.sqrt(12.0)),
    "-box": (0.0, math.sqrt(12.0)),
    "a + b": (13.0, 13.0),
    "a - b": (13.0, 13.0),
    "a + d": (5.0, 5.0),
    "a - d": (15.0, 15.0),
    "a + w": (2.0, 8.0),
    "w + a": (2.0, 8.0),
    "w - a": (2.0, 8.0),
    "a - w": (2.0, 8.0),
    "u + t": (math.sqrt(3.0), math.sqrt(3.25)),
    "u - t": (math.sqrt(0.75), 1.0),
    "u - c": (0.0, 0.25),
    "a + box": (5.0 - math.sqrt(12.0), 5.0 + math.sqrt(12.0)),
    "a * s": (2.5, 10.0),
    "s * a": (2.5, 10.0),
    "a * r": (0.0, 10.0),
    "a * g": (10.0, 20.0),
    "g * a": (10.0, 20.0),
    "w * g": (0.0, 12.0),
    "a * zero": (0.0, 0.0),
    "o * s": (0.0, 0.0),
    "a / s": (2.5, 10.0),
    "a / g": (1.25, 2.5),
    "a / one": (5.0, 5.0),
    "w / s": (0.0, 6.0),
    "a / up": (0.0, 2.5),
    "a if p else b": (5.0, 12.0),
    "b if p else a": (5.0, 12.0),
    "w if p else a": (0.0, 5.0),
    "box if p else u": (0.0, math.sqrt(12.0)),
    "cross(a, b)": (0.0, 60.0),
    "cross(w, b)": (0.0, 36.0),
    "cross(a - b, a + b)": (0.0, 120.0),
    "cross(a - b, b + a)": (0.0, 120.0),
    "cross(a + b, a - b)": (0.0, 169.0),
    "cross(a - b, a + d)": (0.0, 65.0),
    "cross(a - b, a - b)": (0.0, 169.0),
}


@pytest.mark.parametrize("text", EXACT)
def test_lengths_hold_the_exact_ones_and_little_more(text: str) -> None:
    values, lengths, found = made()
    e = expression(values, found, text)
    least, most = lengths.operand(e)
    low, high = EXACT[text]
    near = tolerance("length_bound") * max(1.0, high)
    assert low - near <= least <= low
    assert high <= most <= high + near
    assert least == 0.0 or least < low
    assert most > high
    assert lengths.of(e)[0] == least


UNKNOWN = (
    *("v", "s", "v * s", "s * v", "v / s", "u / r", "u / zero", "v + u", "u - v", "u * t", "v if p else u"),
    *("u if p else v", "cross(v, u)", "cross(u, v)", "abs(u)", "max(u, t)", "u * up", "floor(w)", "-v"),
)


@pytest.mark.parametrize("text", UNKNOWN)
def test_nothing_is_claimed_of_what_is_unknown(text: str) -> None:
    values, lengths, found = made()
    scalar = text == "s"
    assert lengths.of(expression(values, found, text, F32 if scalar else VEC3)) == (0.0, math.inf)


NORMALISED = {
    "inverse_sqrt(dot(a, a)) * a": True,
    "a * inverse_sqrt(dot(a, a))": True,
    "a * inverse_sqrt(max(dot(a, a), r))": True,
    "v * inverse_sqrt(max(dot(v, v), 1.0e-30))": True,
    "v * inverse_sqrt(max(1.0e-30, dot(v, v)))": True,
    f"v * inverse_sqrt(max(dot(v, v), {2.0**-106!r}))": True,
    "v * inverse_sqrt(max(dot(v, v), s))": True,
    "v * inverse_sqrt(max(dot(v, v), r))": False,
    "v * inverse_sqrt(max(dot(v, v), 1.0e-37))": False,
    "v * inverse_sqrt(max(1.0e-37, dot(v, v)))": False,
    f"v * inverse_sqrt(max(dot(v, v), {2.0**-107!r}))": False,
    "inverse_sqrt(dot(v, v)) * v": False,
    "v * inverse_sqrt(dot(v, v))": False,
    "v * inverse_sqrt(max(dot(v, v), 0.0))": False,
    "v * inverse_sqrt(max(s, r))": False,
    "v * inverse_sqrt(min(dot(v, v), 1.0))": False,
    "v * inverse_sqrt(dot(v, w))": False,
    "v * inverse_sqrt(dot(w, v))": False,
    "v * inverse_sqrt(dot(w, w))": False,
    "v * inverse_sqrt(s)": False,
    "v * sqrt(dot(v, v))": False,
    "v / inverse_sqrt(dot(v, v))": False,
    "v * dot(v, v)": False,
}


@pytest.mark.parametrize("text", NORMALISED)
def test_a_vector_over_its_own_length(text: str) -> None:
    values, lengths, found = made()
    found_of = lengths.of(expression(values, found, text))
    assert found_of == ((0.0, 1.0 + norms.UNIT_SLACK) if NORMALISED[text] else (0.0, math.inf))


def test_flushed_squares_lengthen_no_more_than_the_guard_allows() -> None:
    """One square at the guard, two just below what is flushed: by 11 % at a guard of 1e-37."""

    def longest(guard: float) -> float:
        return math.sqrt(1.0 + 2.0 * 2.0**-126 / guard)

    assert longest(1.0e-37) > 1.1
    assert longest(norms.LEAST_SQUARE) < 1.0 + norms.UNIT_SLACK / 2.0 < longest(norms.LEAST_SQUARE / 4.0)


def test_guards_may_be_of_any_size_but_tiny() -> None:
    values, lengths, found = made()
    assert lengths.of(expression(values, found, "v * inverse_sqrt(max(dot(v, v), 4.0))"))[1] < 1.001


def test_what_is_flushed_is_lost() -> None:
    values, lengths, found = made()
    least, most = lengths.of(expression(values, found, "u * tiny"))
    assert least == 0.0
    assert 2.0**-125 < most <= 2.0 * norms.FLUSHED


def test_ends_of_products() -> None:
    _, lengths, found = made()
    for x, y, most in (("a", "b", 60.0), ("w", "b", 36.0), ("long", "u", 100.0), ("u", "long", 100.0)):
        low, high = lengths.product(found[x], found[y])
        size = max(EXACT.get(name, (0.0, 100.0))[1] if name != "b" else 12.0 for name in (x, y))
        assert low == -high
        assert most + 5.0 * STEP * size**2 < high < most + tolerance("length_bound") * size**2
    for x, square in (("a", 25.0), ("b", 144.0)):
        low, high = lengths.product(found[x], found[x])
        room = 5.0 * STEP * square
        assert square - tolerance("length_bound") * square < low < square - room
        assert square + room < high < square + tolerance("length_bound") * square
    assert lengths.product(found["w"], found["w"])[0] == 0.0
    assert lengths.product(found["v"], found["v"]) == (0.0, math.inf)
    assert lengths.product(found["v"], found["u"]) == (-math.inf, math.inf)


def test_roundings_of_cross_products_count_by_the_longer_vector() -> None:
    values, lengths, found = made()
    for text, exact in (
        ("cross(long, u)", 100.0),
        ("cross(u, long)", 100.0),
        ("cross(long - u, long + u)", 200.0),
    ):
        most = lengths.of(expression(values, found, text))[1]
        assert exact + 3.0 * STEP * 100.0**2 < most < exact + tolerance("length_bound") * 100.0**2


def test_a_contradiction_is_told_elsewhere() -> None:
    """Of w and z no product of -40 is possible; whoever asks for its range is told so."""
    values, lengths, found = made()
    assert lengths.of(expression(values, found, "w + z"))[0] == 0.0


def test_arrays_have_the_lengths_of_their_elements() -> None:
    values, lengths, found = made()
    array = values.intern(ir.Construct(ARRAY, (found["a"], found["b"])))
    for e in (array, values.intern(ir.Index(VEC3, array, found["i"]))):
        least, most = lengths.of(e)
        assert least == pytest.approx(5.0, abs=tolerance("length_bound"))
        assert most == pytest.approx(12.0, abs=tolerance("length_bound"))
    us = values.intern(ir.Index(VEC3, found["us"], found["i"]))
    assert lengths.of(us) == lengths.of(found["us"]) == (1.0 - norms.UNIT_SLACK, 1.0 + norms.UNIT_SLACK)
    for e in (values.number(2.0, F32), values.binary("+", found["s"], found["one"])):
        assert lengths.of(e) == (0.0, math.inf)  # numbers have no length
    whole = values.intern(ir.Var(array_of(I32, 2), "ints"))
    assert lengths.of(whole) == (0.0, math.inf)


LETTERS = ("yzzy", "zxxz", "xyyx")


def cross_of(values: Values, letters: Sequence[str], pairs: Sequence[tuple[ir.Expr, ir.Expr]]) -> ir.Expr:
    """Component by component a.i * b.j - a.j * b.i, for letters i j j i."""
    parts = []
    for (first, second, third, fourth), (a, b) in zip(map(tuple, letters), pairs, strict=True):
        component = [
            values.intern(ir.Swizzle(F32, of, c))
            for of, c in ((a, first), (b, second), (a, third), (b, fourth))
        ]
        products = [values.intern(ir.Binary(F32, "*", *component[k : k + 2])) for k in (0, 2)]
        parts.append(values.intern(ir.Binary(F32, "-", *products)))
    return values.intern(ir.Construct(VEC3, tuple(parts)))


def test_a_cross_product_that_is_written_out() -> None:
    values, lengths, found = made()
    a, b = found["a"], found["b"]
    assert lengths.of(cross_of(values, LETTERS, [(a, b)] * 3)) == lengths.of(
        expression(values, found, "cross(a, b)")
    )
    wrong = [
        (("zyyz", "zxxz", "xyyx"), [(a, b)] * 3),
        (("yzzy", "xzzx", "xyyx"), [(a, b)] * 3),
        (("yzzy", "zxxz", "yxxy"), [(a, b)] * 3),
        (("yzyz", "zxxz", "xyyx"), [(a, b)] * 3),
        (("yyzz", "zxxz", "xyyx"), [(a, b)] * 3),
        (LETTERS, [(a, b), (a, b), (b, a)]),
        (LETTERS, [(a, b), (a, found["d"]), (a, b)]),
        (LETTERS, [(a, b), (found["d"], b), (a, b)]),
        (LETTERS, [(b, a), (a, b), (a, b)]),
    ]
    for letters, pairs in wrong:
        assert lengths.of(cross_of(values, letters, pairs)) == (0.0, math.inf)
    scalars = values.intern(ir.Construct(VEC3, (found["s"], found["r"], found["g"])))
    assert lengths.of(scalars) == (0.0, math.inf)


def test_operands_of_one_written_cross_product_come_from_two_vectors() -> None:
    """a.y * b.z - d.z * b.y has three; no cross product does."""
    values, _, found = made()
    a, b, d = found["a"], found["b"], found["d"]
    for four in ((a, b, d, b), (a, b, a, d)):
        parts = []
        for letters in LETTERS:
            of = [values.intern(ir.Swizzle(F32, x, c)) for x, c in zip(four, letters, strict=True)]
            products = [values.intern(ir.Binary(F32, "*", *of[k : k + 2])) for k in (0, 2)]
            parts.append(values.intern(ir.Binary(F32, "-", *products)))
        assert norms.written_cross(ir.Construct(VEC3, tuple(parts))) is None


def test_slacks_are_what_the_tables_permit_with_room() -> None:
    assert norms.UNIT_SLACK / 2.0 < UNIT <= norms.UNIT_SLACK
    assert norms.ROUNDING == 2.0 * STEP
    assert 2.0 * 7.0 * STEP <= norms.PRODUCT < 4.0 * 7.0 * STEP  # of four components
    assert 2.0**5 * math.hypot(*(2.0**-126,) * 4) == norms.FLUSHED  # five operations, each twice as much
