"""Powers with constant whole exponents become multiplications: in every form of the library that has a row.

Plan.
  forms      every form of the two powers has a row, and is multiplied out when asked
  stays      exponents that are no whole numbers or above what was asked
"""

from __future__ import annotations

import pytest

from codegen.library import load_library
from codegen.passes.rules.powers import NAME, ROWS, multiplications
from codegen.passes.specialise import specialise

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


@pytest.mark.parametrize("exponent", [8.5, MOST + 1.0])
def test_other_powers_stay(exponent: float) -> None:
    assert all(steps(name, exponent) == [] for name in ROWS)
