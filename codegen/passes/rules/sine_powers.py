"""Whole exponents of a sine between directions: powers of its square, and one root where the exponent is odd.

before   shell_sine_power(n, l, 1.0)          shell_sine_power(n, h, 24.0)
after    sqrt(s)                              s2 = s * s; s4 = s2 * s2; s8 = s4 * s4; s8 * s4
         with s = |(n - l) x (n + l)|^2 / 4, or max(1 - (n.h)^2, 0.0048) for exponents of 2 and more

Not exact, so only by request, like codegen.passes.rules.powers. The root of 1 - c^2 would err by 5e-4 along
the hair; of higher powers the same rounding is below a millionth.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.passes.rules.powers import NAME, ROUNDING, ROWS, least_base, multiplications, power_of, whole
from codegen.passes.ssa.values import Value, Values

FUNCTION = "shell_sine_power"
EXPONENT = "p"
EXPONENTS: Mapping[str, str] = {**{name: row.exponent for name, row in ROWS.items()}, FUNCTION: EXPONENT}
"""Every function that whole exponents turn into multiplications, and its argument that is the exponent."""
ROUNDINGS = 4
"""Roundings of the square: a product of three components, and the difference from 1."""


def error(exponent: int) -> float:
    """Largest absolute error: of x^(p/2) with x off by a few roundings of 1, and a rounding for each product.

    For p >= 2 the slope of x^(p/2) is p/2 at most; of the sine itself the relative error counts.
    """
    return (max(exponent / 2.0, 1.0) * 2.0 * ROUNDINGS + exponent) * ROUNDING


def whole_sine_exponents(largest: int) -> Callable[[Values, ir.Function, dict[str, Value]], ir.Expr | None]:
    """The rule for sines to constant whole exponents from 1 to `largest`."""

    def rule(values: Values, function: ir.Function, arguments: dict[str, Value]) -> ir.Expr | None:
        if function.name != FUNCTION:
            return None
        n, w, power = arguments["n"], arguments["w"], whole(arguments[EXPONENT], largest)
        if power is None or isinstance(n, dict) or isinstance(w, dict):
            return None
        made = _power(values, n, w, power)
        values.note(
            NAME,
            f"{FUNCTION}({values.show(n)}, {values.show(w)}, {power:g}) -> {_said(power)}",
            f"absolute error at most {error(power):.2g} (either-way rounding)",
        )
        return made

    return rule


def _power(values: Values, n: ir.Expr, w: ir.Expr, power: int) -> ir.Expr:
    if power == 1:
        return values.build(ir.Builtin(F32, "sqrt", (_sine_square(values, n, w),)))
    cosine = values.build(ir.Builtin(F32, "dot", (n, w)))
    left = values.binary("-", values.number(1.0, F32), values.binary("*", cosine, cosine))
    half = power // 2
    square = values.build(ir.Builtin(F32, "max", (left, values.number(least_base(half + 1), F32))))
    made = power_of(values, square, half)
    if power % 2 == 0:
        return made
    return values.binary("*", made, values.build(ir.Builtin(F32, "sqrt", (square,))))


def _sine_square(values: Values, n: ir.Expr, w: ir.Expr) -> ir.Expr:
    """A quarter of the squared length of (n - w) x (n + w), which no cancellation spoils."""
    d, s = values.binary("-", n, w), values.binary("+", n, w)

    def part(v: ir.Expr, i: int) -> ir.Expr:
        return values.build(ir.Swizzle(F32, v, "xyz"[i]))

    squares = []
    for i, j in ((1, 2), (2, 0), (0, 1)):
        side = values.binary(
            "-", values.binary("*", part(d, i), part(s, j)), values.binary("*", part(d, j), part(s, i))
        )
        squares.append(values.binary("*", side, side))
    total = values.binary("+", values.binary("+", squares[0], squares[1]), squares[2])
    return values.binary("*", values.number(0.25, F32), total)


def _said(power: int) -> str:
    if power == 1:
        return "a root"
    products = multiplications(power // 2) + power % 2
    counted = f"{products or 'no'} multiplication{'s' if products > 1 else ''}"
    return counted + (" and a root" if power % 2 else "")
