"""Every operation of the registry means what its name says, in every arithmetic.

Plan. Each row is held against Python's own function or operator on scalars, lane by lane, over numbers of
both signs, in float32, float64 and mpmath; vector operations against sums written out here. So a wrong sign,
an exchanged operand or a neighbouring function (log2 for log) shows in the registry itself.
"""

import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from codegen.evaluate.arrays import ARITHMETICS, arithmetic
from codegen.ir.types import BOOL, F32, TEXTURE, U32, Scalar, Vector
from codegen.ops import BUILTINS, OPERATORS

FLOAT_PAIRS = [(1.5, -0.25), (-2.75, 0.5), (0.125, 3.0), (2.0, 2.0), (-3.5, -1.25), (0.75, -2.0)]
WORD_PAIRS = [(7, 2), (2**32 - 1, 31), (6, 3), (1, 4), (0xF0F0F0F0, 7), (5, 5)]
TRUTH_PAIRS = [(True, True), (True, False), (False, True), (False, False)]
WORD = 2**32
ROUNDING = {"float32": 2.0**-22, "float64": 2.0**-50, "mpmath": 2.0**-50}
"""Largest relative difference from Python's double: a few roundings of each arithmetic."""

BINARY: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "//": operator.floordiv,
    "%": operator.mod,
    "<<": operator.lshift,
    ">>": operator.rshift,
    "&": operator.and_,
    "|": operator.or_,
    "^": operator.xor,
    "min": min,
    "max": max,
    "atan2": math.atan2,
}
UNARY: dict[str, Callable[[Any], Any]] = {
    "negate": operator.neg,
    "not": operator.not_,
    "~": operator.invert,
    "abs": abs,
    "floor": math.floor,
    "sqrt": math.sqrt,
    "inverse_sqrt": lambda x: 1.0 / math.sqrt(x),
    "exp": math.exp,
    "exp2": lambda x: 2.0**x,
    "log": math.log,
    "log2": math.log2,
    "sin": math.sin,
    "cos": math.cos,
}
POSITIVE = {"sqrt", "inverse_sqrt", "log", "log2"}
ROWS = {name: row for name, row in {**OPERATORS, **BUILTINS}.items() if TEXTURE not in row.rule[0][0]}
PAIRS: dict[Scalar, list[tuple[Any, Any]]] = {F32: [*FLOAT_PAIRS], U32: [*WORD_PAIRS], BOOL: [*TRUTH_PAIRS]}


def column(element: Scalar, values: Any, arithmetic_name: str) -> Any:
    a = arithmetic(arithmetic_name)
    if element == F32 and arithmetic_name == "mpmath":
        return np.array([a.literal(v) for v in values], dtype=object)
    return np.array(values, a.dtype(element))


def agree(got: Any, expected: list[Any], arithmetic_name: str) -> None:
    for g, e in zip(got, expected, strict=True):
        if isinstance(e, bool):
            assert bool(g) is e
        else:
            assert float(g) == pytest.approx(float(e), rel=ROUNDING[arithmetic_name], abs=0.0)


def meaning(name: str, arithmetic_name: str, *columns: Any) -> Any:
    with np.errstate(over="ignore"):
        return ROWS[name].meaning(arithmetic(arithmetic_name).namespace, *columns)


@pytest.mark.parametrize("arithmetic_name", ARITHMETICS)
@pytest.mark.parametrize("name", BINARY)
def test_two_operands(name: str, arithmetic_name: str) -> None:
    tried = 0
    for element, pairs in PAIRS.items():
        if ROWS[name].result((element, element)) is None:
            continue
        columns = [column(element, [p[k] for p in pairs], arithmetic_name) for k in (0, 1)]
        expected = [BINARY[name](*p) for p in pairs]
        wrap = element == U32 and not isinstance(expected[0], bool)
        agree(
            meaning(name, arithmetic_name, *columns),
            [e % WORD if wrap else e for e in expected],
            arithmetic_name,
        )
        tried += 1
    assert tried


@pytest.mark.parametrize("arithmetic_name", ARITHMETICS)
@pytest.mark.parametrize("name", UNARY)
def test_one_operand(name: str, arithmetic_name: str) -> None:
    values: dict[Scalar, list[Any]] = {
        F32: [0.75, 2.5, 3.0, 0.0625] + ([] if name in POSITIVE else [-1.5, -0.25]),
        U32: [0, 6, WORD - 1],
        BOOL: [True, False],
    }
    tried = 0
    for element, numbers in values.items():
        if ROWS[name].result((element,)) is None:
            continue
        expected = [UNARY[name](v) for v in numbers]
        got = meaning(name, arithmetic_name, column(element, numbers, arithmetic_name))
        agree(got, [e % WORD if element == U32 else e for e in expected], arithmetic_name)
        tried += 1
    assert tried


@pytest.mark.parametrize("arithmetic_name", ARITHMETICS)
def test_clamp(arithmetic_name: str) -> None:
    lanes = [(2.0, 0.0, 1.0), (-2.0, 0.0, 1.0), (0.25, 0.0, 1.0), (-0.5, -1.0, -0.75)]
    columns = [column(F32, [lane[k] for lane in lanes], arithmetic_name) for k in range(3)]
    agree(meaning("clamp", arithmetic_name, *columns), [1.0, 0.0, 0.25, -0.75], arithmetic_name)


@pytest.mark.parametrize("arithmetic_name", ARITHMETICS)
def test_bits(arithmetic_name: str) -> None:
    floats = column(F32, [1.5, -2.0, 0.1], arithmetic_name)
    words = [0x3FC00000, 0xC0000000, 0x3DCCCCCD]
    assert meaning("float_to_bits", arithmetic_name, floats).tolist() == words
    back = meaning("bits_to_float", arithmetic_name, np.array(words, np.uint32))
    assert [float(x) for x in back] == [1.5, -2.0, float(np.float32(0.1))]


def test_exact_division_by_zero_has_the_values_of_floats() -> None:
    """Lanes that a branch does not take get there."""
    a, b = (
        column(F32, [1.0, -2.0, 0.0, 3.0, math.nan], "mpmath"),
        column(F32, [0.0] * 3 + [2.0, 0.0], "mpmath"),
    )
    got = [float(x) for x in meaning("/", "mpmath", a, b)]
    assert got[:2] == [math.inf, -math.inf]
    assert got[3] == 1.5
    assert math.isnan(got[2])
    assert math.isnan(got[4])


def test_exact_roots_and_logarithms_where_there_are_none() -> None:
    """Lanes that a branch does not take get there; they hold real numbers or none."""
    (root,) = meaning("sqrt", "mpmath", column(F32, [-1.0], "mpmath"))
    assert root != root
    assert meaning("sqrt", "mpmath", column(F32, [0.0], "mpmath"))[0] == 0
    for name in ("log", "log2"):
        found = meaning(name, "mpmath", column(F32, [0.0, -1.0], "mpmath"))
        assert [float(x) for x in found] == [-math.inf, -math.inf]


A = [(1.0, 2.0, 3.0, 5.0), (-1.5, 0.25, 4.0, -2.0)]
B = [(-7.0, 0.5, 11.0, 1.0), (2.0, -3.0, 0.75, 8.0)]


def rows(values: Any, size: int, arithmetic_name: str) -> Any:
    columns = [column(F32, [v[k] for v in values], arithmetic_name) for k in range(size)]
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("arithmetic_name", ARITHMETICS)
@pytest.mark.parametrize("size", [2, 3, 4])
def test_geometry(size: int, arithmetic_name: str) -> None:
    a, b = rows(A, size, arithmetic_name), rows(B, size, arithmetic_name)
    pairs = list(zip(A, B, strict=True))
    dots = [math.fsum(x * y for x, y in zip(p[:size], q[:size], strict=True)) for p, q in pairs]
    agree(meaning("dot", arithmetic_name, a, b), dots, arithmetic_name)
    lengths = [math.hypot(*p[:size]) for p in A]
    agree(meaning("length", arithmetic_name, a), lengths, arithmetic_name)
    units = [x / n for p, n in zip(A, lengths, strict=True) for x in p[:size]]
    agree(meaning("normalize", arithmetic_name, a).ravel(), units, arithmetic_name)
    if size == 3:
        crossed = [
            x
            for p, q in pairs
            for x in (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
        ]
        agree(meaning("cross", arithmetic_name, a, b).ravel(), crossed, arithmetic_name)


def test_dot_adds_from_the_first_component_on() -> None:
    """The evaluator's order is part of its meaning: ((x + y) + z) + w, every operation rounded."""
    a = np.array([[1.0, 2.0**-24, 2.0**-24, 0.0]], np.float32)
    b = np.ones((1, 4), np.float32)
    assert meaning("dot", "float32", a, b)[0] == np.float32(1.0)
    assert meaning("dot", "float32", a[:, ::-1], b)[0] == np.float32(1.0 + 2.0**-23)


def test_every_row_is_held_against_something() -> None:
    here = {*BINARY, *UNARY, "clamp", "float_to_bits", "bits_to_float", "dot", "cross", "length", "normalize"}
    assert here == set(ROWS)


def test_overloads() -> None:
    """Which types an operation takes: floats, whole numbers, truth values, their vectors, scaled ones."""
    kinds = {
        name: "".join(
            letter
            for letter, found in (
                ("f", any(t == (F32,) * len(t) for t, _ in op.rule)),
                ("v", any(isinstance(t[0], Vector) and t[0].element == F32 for t, _ in op.rule)),
                ("u", any(t == (U32,) * len(t) for t, _ in op.rule)),
                ("w", any(isinstance(t[0], Vector) and t[0].element == U32 for t, _ in op.rule)),
                ("b", any(t[0] == BOOL for t, _ in op.rule)),
                (
                    "s",
                    any(
                        len(t) == 2 and isinstance(t[0], Vector) != isinstance(t[1], Vector)
                        for t, _ in op.rule
                    ),
                ),
            )
            if found
        )
        for name, op in ROWS.items()
    }
    expected = {
        "+": "fvuw",
        "-": "fvuw",
        "*": "fvuws",
        "/": "fvs",
        "negate": "fv",
        "min": "fvuw",
        "max": "fvuw",
    }
    expected |= {"clamp": "fvu", "and": "b", "or": "b", "not": "b", "cross": "v", "dot": "v", "length": "v"}
    expected |= dict.fromkeys(("<", "<=", ">", ">=", "==", "!="), "fu")
    expected |= dict.fromkeys(("//", "%", "<<", ">>", "bits_to_float"), "u")
    expected |= dict.fromkeys(("&", "|", "^", "~"), "uw") | {"normalize": "v", "float_to_bits": "f"}
    expected |= dict.fromkeys(("abs", "floor", "sqrt", "inverse_sqrt", "exp", "exp2"), "fv")
    expected |= dict.fromkeys(("log", "log2", "sin", "cos", "atan2"), "fv")
    assert kinds == expected
