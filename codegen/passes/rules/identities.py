"""Algebraic identities, one row each. Read this file as a table.

before   (x - x) * y + 1.0 * z        max(x, min(x, y))
after    z                            x

Rows say why they are sound. `kind`:
  exact   the same value, the sign of a zero aside
  finite  the same value where operands and result are finite, which this library's functions keep
  real    the same real number: the replacement lies among the values that the roundings of the original
          permit where either neighbour may be taken (every table but OpenCL's, which rounds to nearest)
  unit    the same up to the rounding of a unit vector's length
Nothing is re-associated but products with powers of two, which are exact.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass

from codegen.ir import nodes as ir
from codegen.ops import OPERATORS
from codegen.passes.analysis.norms import is_unit
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Rewrite, Rule, Values, constant_components

NAME = "identities"


@dataclass(frozen=True)
class Row:
    """One identity. Names: x y z floats, a b constants, u v w vectors, p q truth values, m n integers.

    pattern      what is looked for, see codegen.passes.ssa.patterns
    replacement  what it becomes
    kind         exact, finite, real or unit
    note         why it is sound
    when         conditions on names, "condition name ...", see CONDITIONS
    """

    pattern: str
    replacement: str
    kind: str
    note: str
    when: tuple[str, ...] = ()


POWER = ("power_of_two a", "constant b")
SCALED = ("varies x", "power_of_two a")
CONSTANTS = ("constant a", "constant b")

ROWS = (
    # Sums
    Row("x + 0", "x", "exact", "adding 0 changes nothing"),
    Row("x - 0", "x", "exact", "subtracting 0 changes nothing"),
    Row("0 - x", "-x", "exact", "0 - x is representable", ("signed x",)),
    Row("x - x", "0", "finite", "the difference of a number and itself is 0"),
    Row("x + -y", "x - y", "exact", "IEEE defines x - y so"),
    Row("x - -y", "x + y", "exact", "IEEE defines x - y as x + (-y)"),
    Row("-(-x)", "x", "exact", "a sign"),
    Row("-(x - y)", "y - x", "exact", "rounding to nearest is symmetric; either neighbour stays a neighbour"),
    # Products
    Row("x * 0", "0", "finite", "0 times a finite number is 0"),
    Row("x * 1", "x", "exact", "the product is representable"),
    Row("x * -1", "-x", "exact", "the product is representable", ("signed x",)),
    Row("-x * -y", "x * y", "exact", "signs"),
    Row("x / 1", "x", "exact", "the quotient is representable, and every table permits it"),
    Row("x / a", "x * (1 / a)", "exact", "the reciprocal of a power of two is one", SCALED),
    Row("0 / x", "0", "finite", "0 over a number that is not 0 is 0"),
    Row("x / x", "1", "finite", "the quotient is representable, and every table permits it", ("nonzero x",)),
    Row("a * (b * x)", "(a * b) * x", "exact", "a power of two moves no rounding of normal results", POWER),
    Row("a * (x + x)", "(a + a) * x", "exact", "powers of two are exact", ("power_of_two a",)),
    # Minima and maxima
    Row("min(x, x)", "x", "exact", "one value"),
    Row("max(x, x)", "x", "exact", "one value"),
    Row("min(x, max(x, y))", "x", "exact", "absorption; the result is an operand"),
    Row("max(x, min(x, y))", "x", "exact", "absorption; the result is an operand"),
    Row("min(x, min(x, y))", "min(x, y)", "exact", "the result is an operand"),
    Row("max(x, max(x, y))", "max(x, y)", "exact", "the result is an operand"),
    Row("min(a, min(b, x))", "min(min(a, b), x)", "exact", "an operand, in any order", CONSTANTS),
    Row("max(a, max(b, x))", "max(max(a, b), x)", "exact", "an operand, in any order", CONSTANTS),
    Row("min(x, a) < b", "x < b", "exact", "what min cuts off is not below b either", ("above a b",)),
    Row("min(x, a) <= b", "x <= b", "exact", "what min cuts off is not below b either", ("above a b",)),
    Row("max(x, b) > a", "x > a", "exact", "what max cuts off is not above a either", ("above a b",)),
    Row("max(x, b) >= a", "x >= a", "exact", "what max cuts off is not above a either", ("above a b",)),
    # Magnitudes, roots
    Row("abs(abs(x))", "abs(x)", "exact", "a sign"),
    Row("abs(-x)", "abs(x)", "exact", "a sign"),
    Row("abs(x * x)", "x * x", "exact", "a square has no sign"),
    Row("sqrt(x * x)", "abs(x)", "real", "the root of a square; exact where nothing is rounded"),
    Row("sqrt(x) * sqrt(x)", "x", "real", "the square of a root"),
    Row("floor(floor(x))", "floor(x)", "exact", "a whole number"),
    # Vectors
    Row("dot(u, 0)", "0", "finite", "products with 0"),
    Row("cross(u, 0)", "0", "finite", "products with 0"),
    Row("cross(0, u)", "0", "finite", "products with 0"),
    Row("cross(u, u)", "0", "finite", "each component is the difference of one product and itself"),
    Row("cross(u, -u)", "0", "finite", "each component is the difference of one product and itself"),
    Row("cross(-u, u)", "0", "finite", "each component is the difference of one product and itself"),
    Row("dot(u, u)", "1", "unit", "the square of a unit vector's length", ("unit u",)),
    Row("length(u)", "1", "unit", "the length of a unit vector", ("unit u",)),
    Row("normalize(u)", "u", "unit", "a unit vector has its direction's length", ("unit u",)),
    # Choices
    Row("x if p else x", "x", "exact", "both sides are one value"),
    Row("x if not p else y", "y if p else x", "exact", "the same choice"),
    Row("(x if p else y) if p else z", "x if p else z", "exact", "the condition is decided inside"),
    Row("x if p else (y if p else z)", "x if p else z", "exact", "the condition is decided inside"),
    Row("True if p else False", "p", "exact", "a truth value"),
    Row("False if p else True", "not p", "exact", "a truth value"),
    # Truth values
    Row("not (not p)", "p", "exact", "logic"),
    Row("p and p", "p", "exact", "logic"),
    Row("p or p", "p", "exact", "logic"),
    Row("p and True", "p", "exact", "logic"),
    Row("p and False", "False", "exact", "logic"),
    Row("p or True", "True", "exact", "logic"),
    Row("p or False", "p", "exact", "logic"),
    Row("not (x < y)", "x >= y", "finite", "numbers are ordered; NaN does not arise"),
    Row("not (x <= y)", "x > y", "finite", "numbers are ordered; NaN does not arise"),
    Row("not (x > y)", "x <= y", "finite", "numbers are ordered; NaN does not arise"),
    Row("not (x >= y)", "x < y", "finite", "numbers are ordered; NaN does not arise"),
    Row("not (x == y)", "x != y", "exact", "logic"),
    Row("not (x != y)", "x == y", "exact", "logic"),
    Row("x < x", "False", "exact", "one value"),
    Row("x > x", "False", "exact", "one value"),
    Row("x <= x", "True", "finite", "one value; NaN does not arise"),
    Row("x >= x", "True", "finite", "one value; NaN does not arise"),
    Row("x == x", "True", "finite", "one value; NaN does not arise"),
    Row("x != x", "False", "finite", "one value; NaN does not arise"),
    # Integers (the rows of sums and products hold for them too)
    Row("n // 1", "n", "exact", "modulo 2^32"),
    Row("n % 1", "0", "exact", "modulo 2^32"),
    Row("n << 0", "n", "exact", "bits"),
    Row("n >> 0", "n", "exact", "bits"),
    Row("n & n", "n", "exact", "bits"),
    Row("n & 0", "0", "exact", "bits"),
    Row("n | n", "n", "exact", "bits"),
    Row("n | 0", "n", "exact", "bits"),
    Row("n ^ n", "0", "exact", "bits"),
    Row("n ^ 0", "n", "exact", "bits"),
    Row("~(~n)", "n", "exact", "bits"),
)  # fmt: skip


def _power_of_two(values: Values, ranges: Ranges, e: ir.Expr) -> bool:
    components = constant_components(e)
    return components is not None and all(
        isinstance(x, float) and math.frexp(abs(x))[0] == 0.5 for x in components
    )


def _constant(values: Values, ranges: Ranges, e: ir.Expr) -> bool:
    return constant_components(e) is not None


def _varies(values: Values, ranges: Ranges, e: ir.Expr) -> bool:
    return constant_components(e) is None


def _signed(values: Values, ranges: Ranges, e: ir.Expr) -> bool:
    return OPERATORS["negate"].result((e.type,)) is not None


def _unit(values: Values, ranges: Ranges, e: ir.Expr) -> bool:
    return is_unit(values, e)


def _nonzero(values: Values, ranges: Ranges, e: ir.Expr) -> bool:
    return all(b.low > 0.0 or b.high < 0.0 for b in ranges.bounds(e))


def _above(values: Values, ranges: Ranges, a: ir.Expr, b: ir.Expr) -> bool:
    return isinstance(a, ir.Const) and isinstance(b, ir.Const) and a.value > b.value


CONDITIONS: dict[str, Callable[..., bool]] = {
    "power_of_two": _power_of_two,
    "constant": _constant,
    "varies": _varies,
    "signed": _signed,
    "unit": _unit,
    "nonzero": _nonzero,
    "above": _above,
}


@dataclass(frozen=True)
class _Ready:
    """A row as it is applied: its patterns, and its conditions with the names that they speak of."""

    row: Row
    pattern: patterns.Operation
    replacement: patterns.Pattern
    conditions: tuple[tuple[Callable[..., bool], tuple[str, ...]], ...]


@functools.cache
def _rows() -> tuple[_Ready, ...]:
    """All rows, in order."""
    found = []
    for row in ROWS:
        pattern = patterns.parse(row.pattern)
        assert isinstance(pattern, patterns.Operation)
        tests = tuple((CONDITIONS[test], tuple(names)) for test, *names in map(str.split, row.when))
        found.append(_Ready(row, pattern, patterns.parse(row.replacement), tests))
    return tuple(found)


def identities(ranges: Ranges, kinds: frozenset[str]) -> Rule:
    """The rule that applies the rows of these kinds."""

    def rule(values: Values, e: ir.Expr) -> Rewrite | None:
        operation = patterns.operation(e)
        if operation is None:
            return None
        for ready in _candidates(kinds, operation, patterns.outlines(e)):
            for found in patterns.match(ready.pattern, e):
                if all(test(values, ranges, *[found[n] for n in names]) for test, names in ready.conditions):
                    value = patterns.make(ready.replacement, found, values, e.type)
                    row = ready.row
                    return Rewrite(value, NAME, f"{row.pattern} = {row.replacement}, {row.kind}: {row.note}")
        return None

    return rule


@functools.cache
def _candidates(
    kinds: frozenset[str], operation: str, outlines: tuple[patterns.Outline, ...]
) -> list[_Ready]:
    """The rows of these kinds that a value with these operands may fit."""
    return [
        ready
        for ready in _rows()
        if ready.row.kind in kinds
        and ready.pattern.op == operation
        and patterns.may_match(ready.pattern, outlines)
    ]
