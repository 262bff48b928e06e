"""Powers with constant whole exponents become multiplications: in every form of the library that has a row.

Plan.
  forms      every form of the two powers has a row, and is multiplied out when asked
  stays      exponents that are no whole numbers or above what was asked
  error      what is stated covers every operation rounded the same way
  products   as many as are told, and of as many numbers: every exponent in exact numbers
  ends       bases end where powers stay normal numbers, and where powers saturate; a power of 1 is its base
"""

from __future__ import annotations

from fractions import Fraction

import pytest

from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.library import load_library
from codegen.passes.rules.powers import (
    LARGEST,
    NAME,
    ROUNDING,
    ROWS,
    error,
    largest_base,
    least_base,
    multiplications,
    power_of,
)
from codegen.passes.specialise import specialise
from codegen.passes.ssa.values import Values

LIBRARY = load_library()
BASES = ("pow_one_minus", "safe_pow")
FORMS = [f.name for f in LIBRARY.functions.values() if f.public and (f.name in BASES or f.base in BASES)]
MOST = 64


def steps(name: str, exponent: float) -> list[str]:
    found = specialise(LIBRARY, name, constants={ROWS[name].exponent: exponent}, new_name="f", powers=MOST)
    return [s.what for s in found.log if s.name == NAME]


def test_every_form_has_a_row() -> None:
    printed = {f.name for f in LIBRARY.functions.values() if f.kind == "printed"}
    assert set(FORMS) - printed == set(ROWS)


@pytest.mark.parametrize("name", ROWS)
def test_whole_power_is_multiplied_out(name: str) -> None:
    for exponent, products in ((8, 3), (13, 5), (MOST, 6)):
        assert multiplications(exponent) == products
        (step,) = steps(name, float(exponent))
        assert step.endswith(f", {exponent}) -> {products} multiplications")


def test_forms_of_one_base_err_alike() -> None:
    roundings = {(row.base, row.roundings) for row in ROWS.values()}
    assert len(roundings) == len({base for base, _ in roundings}) == len(BASES)


def test_products_are_named_after_what_they_are() -> None:
    made = specialise(LIBRARY, "pow_one_minus", constants={"p": 13.0}, new_name="f", powers=MOST).function
    assert [s.name for s in made.body if isinstance(s, ir.Let)] == ["base", "power_2", "power_4"]


@pytest.mark.parametrize("exponent", [8.5, MOST + 1.0])
def test_other_powers_stay(exponent: float) -> None:
    assert all(steps(name, exponent) == [] for name in ROWS)


@pytest.mark.parametrize("roundings", [0, 1])
def test_stated_error_covers_all_roundings_upwards(roundings: int) -> None:
    for exponent in (1, 2, 7, MOST, LARGEST):
        all_up = (1 + Fraction(ROUNDING)) ** (exponent * roundings + exponent - 1)
        assert all_up - 1 <= Fraction(error(exponent, roundings))


def exponent_of(e: ir.Expr, products: set[int]) -> int:
    """The exponent that products of one variable come to."""
    if isinstance(e, ir.Var):
        return 1
    assert isinstance(e, ir.Binary) and e.op == "*"
    products.add(id(e))
    return exponent_of(e.left, products) + exponent_of(e.right, products)


@pytest.mark.parametrize("power", [*range(1, 40), 63, 64, 65, 100, 255, 1000, 1024])
def test_products_of_squares_are_the_power(power: int) -> None:
    values = Values()
    products: set[int] = set()
    made = power_of(values, values.intern(ir.Var(F32, "x")), power)
    assert exponent_of(made, products) == power
    assert len(products) == multiplications(power)


def test_bases_end_where_powers_stay_normal_and_finite() -> None:
    assert least_base(1) == 0.0
    for power in range(1, 1025):
        if power > 1:
            least = Fraction(least_base(power)) ** power
            assert Fraction(2) ** -101 < least < Fraction(2) ** -99
        largest = Fraction(largest_base(power)) ** power
        assert 5.5e34 < largest < 5.6e34
