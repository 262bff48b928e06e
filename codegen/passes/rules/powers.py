"""Whole exponents: a call of a power with a constant whole exponent becomes multiplications.

before   pow_one_minus(q, 16.0)
after    r = max(1 - q, 0.0131); r2 = r * r; r4 = r2 * r2; r8 = r4 * r4; r8 * r8

Not exact, so only by request: (1 - q) is rounded once, the exponent multiplies that error, and each product
adds its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.passes.ssa.values import FIELD, Value, Values

NAME = "powers"
ROUNDING = 2.0**-23
"""Relative error of one operation where either neighbour may be taken."""
LARGEST = 1024
"""Largest exponent for which multiplying is considered."""


@dataclass(frozen=True)
class Row:
    """A library function that is a power.

    base      name of its argument and how the base of the power comes from it
    exponent  name of the argument that is the exponent
    roundings how many operations the base itself takes
    """

    argument: str
    exponent: str
    base: Callable[[Values, ir.Expr, int], ir.Expr]
    roundings: int


def _one_minus(values: Values, q: ir.Expr, power: int) -> ir.Expr:
    left = values.binary("-", values.number(1.0, F32), q)
    return values.build(ir.Builtin(F32, "max", (left, values.number(least_base(power), F32))))


def _between(values: Values, x: ir.Expr, power: int) -> ir.Expr:
    ends = (values.number(end, F32) for end in (least_base(power), largest_base(power)))
    return values.build(ir.Builtin(F32, "clamp", (x, *ends)))


def least_base(power: int) -> float:
    """The least base of a power: the power is then 2^-100 at least, 0 to the eye but a normal number.

    Numbers below 2^-126 take a CPU a hundred times as long as others.
    """
    return float(np.float32(2.0 ** (-100.0 / power))) if power > 1 else 0.0


def largest_base(power: int) -> float:
    """The largest base of a power: there the power is e^80, where safe_pow saturates, and stays finite."""
    return float(np.float32(math.exp(80.0 / power)))


ROWS: Mapping[str, Row] = {
    "pow_one_minus": Row("q", "p", _one_minus, 1),
    "pow_one_minus_from4": Row("q", "p", _one_minus, 1),
    "pow_one_minus_gauss": Row("q", "p", _one_minus, 1),
    "pow_one_minus_sq16": Row("q", "p", _one_minus, 1),
    "pow_one_minus_from8": Row("q", "p", _one_minus, 1),
    "pow_one_minus_cubic8": Row("q", "p", _one_minus, 1),
    "safe_pow": Row("x", "y", _between, 0),
    "safe_pow_exp2": Row("x", "y", _between, 0),
    "safe_pow_near_one": Row("x", "y", _between, 0),
}


def error(exponent: int, roundings: int) -> float:
    """Relative error of the multiplied power: the base's, times the exponent, and one for each product."""
    return (exponent * roundings + exponent - 1) * ROUNDING * (1.0 + 2.0**-10)


def whole_exponents(
    largest: int = LARGEST,
) -> Callable[[Values, ir.Function, dict[str, Value]], ir.Expr | None]:
    """The rule for calls with constant whole exponents from 1 to `largest`."""

    def rule(values: Values, function: ir.Function, arguments: dict[str, Value]) -> ir.Expr | None:
        row = ROWS.get(function.name)
        power = None if row is None else whole(arguments[row.exponent], largest)
        if row is None or power is None:
            return None
        of = arguments[row.argument]
        if isinstance(of, dict):
            return None
        made = power_of(values, row.base(values, of, power), power)
        values.note(
            NAME,
            f"{function.name}({values.show(of)}, {power:g}) -> {multiplications(power)} multiplications",
            f"relative error at most {error(power, row.roundings):.2g} (either-way rounding), or 8e-31",
        )
        return made

    return rule


def whole(exponent: Value, largest: int = LARGEST) -> int | None:
    """The exponent, if it is a constant whole number from 1 to `largest`."""
    if not isinstance(exponent, ir.Const):
        return None
    power = float(exponent.value)
    return int(power) if power == int(power) and 1 <= power <= largest else None


def multiplications(power: int) -> int:
    """How many products binary powers take."""
    return power.bit_length() - 1 + power.bit_count() - 1


def power_of(values: Values, base: ir.Expr, power: int) -> ir.Expr:
    """The base to a whole power, at least 1, by products of its squares."""
    made: ir.Expr | None = None
    square, reached = base, 1
    values.hint(base, "base", FIELD)
    while True:
        if power & reached:
            made = square if made is None else values.binary("*", made, square)
        reached *= 2
        if reached > power:
            assert made is not None
            return made
        square = values.binary("*", square, square)
        values.hint(square, f"power_{reached}", FIELD)
