"""Operations over many lanes by compiled loops: the same values, bit for bit, and where there is a loop.

Plan. Each operation on the same operands twice, with loops and without: intervals and points of many lanes,
or shared by all; ordinary ones, ends at 0 and about the smallest and the largest float, some lanes that may
be anything, operands that are rounded products, an operand with itself.
  same    ends, causes and reasons, the unrounded product, and whether a value is one known number
  loop    ordinary lanes are settled by a loop where the table has one, which leaves none to be looked at
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from codegen.intervals import (
    TABLES,
    arithmetic,
    bulk,
    compiled,
    elementary,
    geometry,
    load_table,
    logic,
    products,
)
from codegen.intervals.accuracy import Absolute
from codegen.intervals.causes import Cause, CauseBook
from codegen.intervals.context import Context
from codegen.intervals.tables import Table
from codegen.intervals.values import Product, Range, Truth

pytest.importorskip("numba")

SEED = 20_263
LANES = 24
SMALLEST, LARGEST = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)
SPECIAL = (0.0, SMALLEST, SMALLEST / 4.0, 2.0**-149, LARGEST, 1e30, 1e-30, 1.0, 2.0, 0.75, 2.0**-63, 2.0**63)
SETTINGS = {name: load_table(name) for name in ("wgsl", "opencl", "opencl_relaxed")}
"""Tables among which all settings and kinds of rows are that a loop may meet."""
SETTINGS["apart"] = replace(SETTINGS["opencl"], fused=False)
KINDS = ("interval", "point", "shared", "shared point", "anything", "product")
PALETTES = ("ordinary", "special")


@pytest.fixture(autouse=True)
def loops_for_few_lanes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "FEWEST", 2)


def context(table: Table, loops: bool, lanes: int = LANES) -> Context:
    made = Context(table, CauseBook(), lanes)
    assert made.loops == table.flush
    made.loops = loops
    for line in (1, 2):  # what operands that may be anything were told of
        made.book.code(Cause("earlier", line, "/", "y", "the divisor may be 0"))
    return made


def numbers(rng: np.random.Generator, palette: str, count: int) -> Any:
    sign = rng.choice([-1.0, 1.0], count)
    if palette == "ordinary":
        return rng.uniform(1.0, 9.0, count).astype(np.float32).astype(np.float64)
    some = np.array(SPECIAL)[rng.integers(0, len(SPECIAL), count)]
    return sign * np.where(rng.integers(0, 4, count) == 0, rng.uniform(0.0, 4.0, count), some).astype(
        np.float32
    ).astype(np.float64)


def operand(rng: np.random.Generator, kind: str, palette: str) -> Range:
    count = 1 if "shared" in kind else LANES
    p, q = numbers(rng, palette, count), numbers(rng, palette, count)
    q = np.where(rng.integers(0, 4, count) == 0, p, q)  # some lanes are known
    low, high = np.minimum(p, q), np.maximum(p, q)
    if "point" in kind:
        return Range(p, p)
    if kind == "anything":
        codes = ((np.arange(LANES) % 3 == 1) * rng.integers(1, 3)).astype(np.int16)
        return arithmetic.anything(low, high, codes)
    if kind == "product":  # what was rounded to these ends may have been anything between their neighbours
        step, one = 2.0**-26, np.ones(1)
        least, most = low - np.abs(low) * step, high + np.abs(high) * step
        return Range(low, high, None, Product((least, most), (one, one)))
    return Range(low, high)


def ends_of(found: Range | Truth) -> tuple[Any, Any]:
    return (found.true, found.false) if isinstance(found, Truth) else (found.low, found.high)


def as_told(found: Range | Truth, told: Context) -> tuple[Any, ...]:
    """All that is known of a value."""

    lanes = max(LANES if len(end) == 1 else len(end) for end in ends_of(found))

    def spread(x: Any) -> Any:
        return np.broadcast_to(x, lanes)

    if isinstance(found, Truth):
        return ("truth", spread(found.true), spread(found.false), told.forks)
    codes = spread(np.zeros(1, np.int16) if found.cause is None else found.cause)
    # What is unrounded counts only where the rounded value is bounded.
    product: list[Any] = []
    if found.product is not None and found.product.first is not None:
        with np.errstate(invalid="ignore"):
            product = [np.where(codes > 0, 0.0, end) for end in products.unrounded(found.product)]
    ends = [spread(end) for end in (*ends_of(found), *product)]
    return (found.is_point, *ends, codes, tuple(told.book.causes), told.forks)


def assert_same(table: Table, apply: Callable[[Context], Any]) -> None:
    seen = []
    for loops in (True, False):
        here = context(table, loops)
        with np.errstate(all="ignore"):
            found = apply(here)
        parts = found if isinstance(found, tuple) else (found,)
        seen.append([as_told(part, here) for part in parts])
    for with_loops, plain in zip(*seen, strict=True):
        for a, b in zip(with_loops, plain, strict=True):
            assert np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b


def divide(context: Context, x: Range, y: Range) -> Range:
    return arithmetic.divide(context, context.table.row("/"), x, y)


PAIRED: dict[str, Callable[[Context, Range, Range], Any]] = {
    "+": arithmetic.add,
    "-": arithmetic.subtract,
    "*": arithmetic.multiply,
    "/": divide,
    **{
        op: lambda context, a, b, op=op: logic.compare(context, op, a, b)  # type: ignore[misc]
        for op in ("<", "<=", ">", ">=", "==", "!=")
    },
}
SINGLE: dict[str, Callable[[Context, Range], Any]] = {
    "sqrt": elementary.square_root,
    "inverse_sqrt": elementary.inverse_square_root,
    **{n: lambda c, x, n=n: elementary.logarithm(c, n, x) for n in ("log", "log2")},  # type: ignore[misc]
    **{n: lambda c, x, n=n: elementary.exponential(c, n, x) for n in ("exp", "exp2")},  # type: ignore[misc]
    **{n: lambda c, x, n=n: elementary.sine(c, n, x) for n in ("sin", "cos")},  # type: ignore[misc]
}


@pytest.mark.parametrize(
    ("op", "table"), [(op, t) for op in PAIRED for t in SETTINGS if op in "+-*/" or t == "wgsl"]
)
def test_two_operands(op: str, table: str) -> None:
    rng = np.random.default_rng(SEED)
    for k, kinds in enumerate(itertools.product(KINDS, KINDS)):
        palette = PALETTES[k % 7 < 4]
        a, b = (operand(rng, kind, palette) for kind in kinds)
        assert_same(SETTINGS[table], lambda here, a=a, b=b: PAIRED[op](here, a, b))  # type: ignore[misc]
        if kinds[0] == kinds[1]:
            assert_same(SETTINGS[table], lambda here, a=a: PAIRED[op](here, a, a))  # type: ignore[misc]


FACTORS = ("interval", "point", "shared", "anything")
ADDED: dict[str, Callable[[Context, Range, Range], Range]] = {
    "p + c": arithmetic.add,
    "c + p": lambda here, p, c: arithmetic.add(here, c, p),
    "p - c": arithmetic.subtract,
    "c - p": lambda here, p, c: arithmetic.subtract(here, c, p),
    "c + -p": lambda here, p, c: arithmetic.add(here, c, arithmetic.negate(p)),
    "c - -p": lambda here, p, c: arithmetic.subtract(here, c, arithmetic.negate(p)),
    "p - c c": lambda here, p, c: arithmetic.subtract(here, p, arithmetic.multiply(here, c, c)),
    "p + -(c p)": lambda here, p, c: arithmetic.add(
        here, p, arithmetic.negate(arithmetic.multiply(here, c, p))
    ),
    "p - p": lambda here, p, c: arithmetic.subtract(here, p, p),
}


@pytest.mark.parametrize("table", SETTINGS)
@pytest.mark.parametrize("text", ADDED)
def test_products_that_are_added(text: str, table: str) -> None:
    """Of two values and of one with itself, on either side of a sum and with either sign."""
    rng = np.random.default_rng(SEED)
    for k, kinds in enumerate(itertools.product(FACTORS, FACTORS, KINDS[:4])):
        p, q, c = (operand(rng, kind, PALETTES[k % 7 < 4]) for kind in kinds)
        for other in (q, p):

            def apply(here: Context, a: Range = p, b: Range = other, c: Range = c) -> Range:
                return ADDED[text](here, arithmetic.multiply(here, a, b), c)

            assert_same(SETTINGS[table], apply)


@pytest.mark.parametrize("table", SETTINGS)
@pytest.mark.parametrize("op", SINGLE)
def test_one_operand(op: str, table: str) -> None:
    rng = np.random.default_rng(SEED)
    for palette, kind in itertools.product(PALETTES, KINDS):
        x = operand(rng, kind, palette)
        assert_same(SETTINGS[table], lambda here, x=x: SINGLE[op](here, x))  # type: ignore[misc]


@pytest.mark.parametrize("op", ["+", "-", "*", "/", "sqrt", "inverse_sqrt", "log", "exp"])
def test_one_lane_in_question(op: str) -> None:
    """A lane that has to be looked at is, though no other has to."""
    values = [sign * x for x in SPECIAL for sign in (1.0, -1.0)]
    boxes = [(x, x) for x in values] + [
        (0.0, 1.0),
        (-1.0, 1.0),
        (-2.0, -1.0),
        (SMALLEST / 2.0, 1.0),
        (1.0, 1e38),
    ]
    both = op in PAIRED
    for p, q in itertools.product(boxes, boxes[:: 2 if both else 99]):
        x, y = (Range(np.array([1.0, box[0]]), np.array([1.5, box[1]])) for box in (p, q))
        for table in ("wgsl", "opencl"):
            assert_same(
                SETTINGS[table],
                lambda here, x=x, y=y: PAIRED[op](here, x, y) if both else SINGLE[op](here, x),  # type: ignore[misc]
            )


def test_sums_of_three_that_overflow_on_one_way_only() -> None:
    large, small = 3e38, 1.0
    terms = [Range(np.array([small, x]), np.array([small, x + 1e31])) for x in (large, large, -large)]
    ones = Range(np.ones(2), np.full(2, 1.5))
    assert_same(SETTINGS["wgsl"], lambda here: geometry.sum_in_any_order(here, terms))
    assert bulk.sum_of_three(context(SETTINGS["wgsl"], True, 2), terms) is None
    assert bulk.sum_of_three(context(SETTINGS["wgsl"], True, 2), [terms[0], terms[2], ones]) is not None


VECTORS: dict[str, Callable[[Context, Any, Any], Any]] = {
    "dot": geometry.dot,
    "cross": geometry.cross,
    "length": lambda context, a, b: geometry.length(context, a),
    "normalize": lambda context, a, b: geometry.normalize(context, a),
}
SHAPES = (
    ("interval",) * 2,
    ("interval",) * 3,
    ("interval",) * 4,
    ("point",) * 3,
    ("shared", "interval", "interval"),
    ("interval", "anything", "interval"),
    ("interval", "interval", "shared point"),
)


@pytest.mark.parametrize(
    ("op", "table"), [(op, t) for op in VECTORS for t in ("wgsl", "opencl")] + [("normalize", "vulkan")]
)
def test_vectors(op: str, table: str) -> None:
    rng = np.random.default_rng(SEED)
    for palette, kinds in itertools.product(PALETTES, SHAPES):
        if op == "cross" and len(kinds) != 3:
            continue
        a, b = (tuple(operand(rng, kind, palette) for kind in kinds) for _ in range(2))
        plain = tuple(operand(rng, "interval", palette) for _ in kinds)
        others = (b, a, (a[0], *b[1:]), plain) if op == "dot" else (plain,)
        for other in others:
            assert_same(load_table(table), lambda here, a=a, b=other: VECTORS[op](here, a, b))  # type: ignore[misc]


def limited(table: str, operation: str, operand: str, near: int, far: int) -> Table:
    """The table with a promise for magnitudes of an operand between two powers of two only."""
    made = load_table(table)
    row = replace(made.row(operation), magnitude={operand: (near, far)})
    return replace(made, rows={**made.rows, operation: row})


@pytest.mark.parametrize(("operation", "name"), [("/", "x"), ("/", "y"), ("inverse_sqrt", "x")])
def test_nearer_limits(operation: str, name: str) -> None:
    """Of either operand of a quotient, and of what a square root is made of."""
    rng = np.random.default_rng(SEED)
    for near, far in ((-3, 3), (0, 1)):
        nearer = limited("wgsl", operation, name, near, far)
        for palette, kinds in itertools.product(PALETTES, itertools.product(KINDS[:3], KINDS[:3])):
            x, y = (operand(rng, kind, palette) for kind in kinds)
            assert_same(nearer, lambda here, x=x, y=y: divide(here, x, y))  # type: ignore[misc]
            assert_same(nearer, lambda here, x=x: elementary.square_root(here, x))  # type: ignore[misc]


def test_root_of_a_table_without_limits() -> None:
    """Each of the two rows in its place, also where a loop would take either."""
    rng = np.random.default_rng(SEED)
    made = load_table("wgsl")
    boundless = replace(made, rows={**made.rows, "/": replace(made.row("/"), magnitude={})})
    for palette, kind in itertools.product(PALETTES, KINDS):
        x = operand(rng, kind, palette)
        assert_same(boundless, lambda here, x=x: elementary.square_root(here, x))  # type: ignore[misc]


def ordinary(kind: str = "interval") -> Range:
    return operand(np.random.default_rng(SEED), kind, "ordinary")


def tables(rounding: str) -> list[Table]:
    return [t for t in map(load_table, TABLES) if t.rounding == rounding]


def settled(found: Any) -> bool:
    """Whether a loop gave it, and no lane has to be looked at."""
    return found is not None and not found[2]


def test_ordinary_lanes_are_settled_by_a_loop() -> None:
    many, known, shared = ordinary(), ordinary("point"), ordinary("shared")
    for table in tables("either") + tables("nearest"):
        here, either = context(table, True), table.rounding == "either"
        for a, b in ((many, known), (many, shared), (shared, many), (known, many)):
            assert settled(bulk.add(here, a, b)) and settled(bulk.multiply(here, a, b))
            assert settled(bulk.subtract(here, a, b))
        assert settled(bulk.add(here, known, known)) and settled(
            bulk.multiply(here, known, ordinary("point"))
        )
        assert settled(bulk.multiply(here, many, many))
        row = table.row("/")
        assert settled(bulk.divide(here, row, many, shared)) == (not row.normal)
        nothing = Range(np.zeros(LANES), np.zeros(LANES))
        allowed = "x" in row.zero or not ("x" in row.magnitude or row.normal)
        assert settled(bulk.divide(here, row, nothing, shared)) == allowed
        around = Range(np.zeros(LANES), many.high)
        assert settled(bulk.divide(here, row, around, shared)) == (not ("x" in row.magnitude or row.normal))
        assert settled(bulk.within_ulp(here, many.low, many.high, 1.0, 1.0))
        causes = np.arange(LANES) % 2
        assert settled(bulk.unknown(here, many.low, many.high, causes))
        assert settled(bulk.unknown(here, many.low[:1], many.high[:1], causes))
        assert settled(bulk.unknown(here, many.low, many.high, causes[1:2]))
        assert bulk.unknown(here, many.low[:1], many.high[:1], causes[:1]) is None
        root, quotient = table.row("inverse_sqrt"), table.row("/")
        assert settled(bulk.inverse_square_root(here, many, root))
        assert settled(bulk.square_root(here, many, root, quotient)) == ("x" not in quotient.magnitude)
        vector, other = (many, ordinary(), many), (ordinary(), many, ordinary())
        assert (bulk.sum_of_three(here, list(vector)) is not None) == either
        assert settled(bulk.scaled_dot(here, vector, other, 4.0, 2.0**-23))
        assert settled(bulk.scaled_dot(here, vector, vector, 4.0, 2.0**-23))
        promise = table.row("log").accuracy
        if isinstance(promise, Absolute):
            assert settled(bulk.absolute_or_ulp(here, promise, many, many.low, many.high))
            assert (
                bulk.absolute_or_ulp(here, replace(promise, elsewhere=None), many, many.low, many.high)
                is None
            )


@pytest.mark.parametrize("op", ["<", "<=", ">", ">=", "==", "!="])
def test_comparisons_that_have_a_loop(op: str) -> None:
    here, many = context(load_table("wgsl"), True), ordinary()
    far = Range(many.low + 100.0, many.high + 100.0)
    assert settled(bulk.compare(here, op, many, far))
    assert bulk.compare(here, op, many, many) is None
    assert here.forks == 0


def test_no_loop_for_what_all_lanes_share_nor_where_none_is_wanted() -> None:
    for table in map(load_table, TABLES):
        for loops, x in ((True, ordinary("shared")), (False, ordinary()), (True, ordinary("shared point"))):
            here, three = context(table, loops), (x, ordinary("shared"), x)
            given = [
                bulk.add(here, x, x),
                bulk.subtract(here, x, ordinary("shared")),
                bulk.multiply(here, x, ordinary("shared")),
                bulk.compare(here, "<", x, ordinary("shared")),
                bulk.divide(here, table.row("/"), x, x),
                bulk.within_ulp(here, x.low, x.high, 1.0, 1.0),
                bulk.inverse_square_root(here, x, table.row("inverse_sqrt")),
                bulk.square_root(here, x, table.row("inverse_sqrt"), table.row("/")),
                bulk.sum_of_three(here, list(three)),
                bulk.scaled_dot(here, three, three, 4.0, 2.0**-23),
            ]
            assert all(found is None for found in given)


def test_two_lanes_are_many() -> None:
    two = Range(np.array([1.0, 2.0]), np.array([1.5, 2.5]))
    assert settled(bulk.add(context(load_table("wgsl"), True, 2), two, two))


def test_what_lanes_share_comes_last() -> None:
    """In operations that commute, so that fewer kinds of loops are compiled."""
    many, shared = ordinary(), ordinary("shared")
    assert bulk._shared_last(shared, many) == bulk._shared_last(many, shared) == (many, shared)
