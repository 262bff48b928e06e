"""Powers that become products: rule by rule, in exact numbers, with the errors that they state.

Plan. (Accuracy in float32: test_passes_powers, test_passes_sine_powers.)
  table   every function that is a power, what its base is, what is told of exponent 5
  value   the exact power at points where every root is a whole fraction; bases beyond their ends stay there
  stays   other functions, other exponents, what is no number
  error   bounds in units of 2^-23, counted by hand
"""

from __future__ import annotations

from fractions import Fraction

import pytest

from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.types import F32, VEC3
from codegen.library import load_library
from codegen.passes.rules import powers, sine_powers
from codegen.passes.ssa.values import FIELD, Step, Value, Values
from conformance.unit.support.plain import value_of
from conformance.unit.support.trees import function_of

ONE_MINUS = "relative error at most 1.1e-06 (either-way rounding), or 8e-31"
PLAIN = "relative error at most 4.8e-07 (either-way rounding), or 8e-31"
"""Of a fifth power: 5 + 4 and 4 roundings of 2^-23."""
TABLE = {
    **dict.fromkeys(
        ("pow_one_minus", "pow_one_minus_from4", "pow_one_minus_gauss", "pow_one_minus_sq16",
         "pow_one_minus_from8", "pow_one_minus_cubic8"), ("q", "p", ONE_MINUS)
    ),
    **dict.fromkeys(("safe_pow", "safe_pow_exp2", "safe_pow_near_one"), ("x", "y", PLAIN)),
}  # fmt: skip
SINE = "shell_sine_power"


def function(name: str) -> ir.Function:
    return function_of(ir.Var(F32, "x"), name, Place("", 1))


def constant(values: Values, x: float) -> ir.Expr:
    return values.number(x, F32)


def multiplied(name: str, exponent: float, largest: int = 64) -> tuple[ir.Expr | None, Values]:
    values = Values(function="f", line=7)
    argument, power, _ = TABLE[name]
    given: dict[str, Value] = {
        argument: values.intern(ir.Var(F32, argument)),
        power: constant(values, exponent),
    }
    return powers.whole_exponents(largest)(values, function(name), given), values


def test_every_power_has_its_row() -> None:
    assert set(powers.ROWS) == set(TABLE)
    for name, (argument, power, _) in TABLE.items():
        parameters = [p.name for p in load_library().function(name).parameters]
        assert parameters == [argument, power]


@pytest.mark.parametrize("name", TABLE)
def test_fifth_power(name: str) -> None:
    made, values = multiplied(name, 5.0)
    argument, _, why = TABLE[name]
    assert made is not None
    x = Fraction(1, 4) if argument == "q" else Fraction(3, 4)
    assert value_of(made, {argument: x}) == Fraction(3, 4) ** 5
    low = 2.0 if argument == "q" else -1.0
    assert 2.0**-101 < value_of(made, {argument: Fraction(low)}) < 2.0**-99
    if argument == "x":
        assert 5.5e34 < value_of(made, {"x": Fraction(10) ** 9}) < 5.6e34
    assert values.log == [Step("powers", f"{name}({argument}, 5) -> 3 multiplications", why, "f:7")]
    hints = {hint.name for hint in values.hints.values()}
    assert hints == {"base", "power_2", "power_4"}
    assert {hint.rank for hint in values.hints.values()} == {FIELD}


@pytest.mark.parametrize("name", TABLE)
def test_first_power_is_the_base(name: str) -> None:
    made, values = multiplied(name, 1.0)
    assert made is not None
    argument = TABLE[name][0]
    assert value_of(made, {argument: Fraction(1, 4)}) == Fraction(3 if argument == "q" else 1, 4)
    assert value_of(made, {argument: Fraction(2 if argument == "q" else -1)}) == 0
    assert values.log[0].what.endswith("-> 0 multiplications")


@pytest.mark.parametrize(("exponent", "largest"), [(0.0, 64), (-1.0, 64), (2.5, 64), (65.0, 64), (3.0, 2)])
def test_other_exponents_stay_calls(exponent: float, largest: int) -> None:
    for name in TABLE:
        made, values = multiplied(name, exponent, largest)
        assert made is None
        assert not values.log


def test_what_is_no_power_stays() -> None:
    values = Values()
    x, two = values.intern(ir.Var(F32, "x")), constant(values, 2.0)
    rule = powers.whole_exponents()
    assert rule(values, function("safe_sqrt"), {"x": x, "y": two}) is None
    assert rule(values, function("safe_pow"), {"x": x, "y": x}) is None
    assert rule(values, function("safe_pow"), {"x": {"part": x}, "y": two}) is None
    assert rule(values, function("safe_pow"), {"x": x, "y": {"part": two}}) is None
    assert not values.log
    assert powers.whole(constant(values, 1024.0)) == 1024
    assert powers.whole(constant(values, 1025.0)) is None
    assert rule(values, function("safe_pow"), {"x": x, "y": constant(values, 1024.0)}) is not None


@pytest.mark.parametrize("roundings", [0, 1, 2])
def test_stated_error_is_that_of_all_roundings_and_little_more(roundings: int) -> None:
    for exponent in (1, 2, 5, 64, 1024):
        counted = Fraction(exponent * roundings + exponent - 1) / 2**23
        assert counted <= Fraction(powers.error(exponent, roundings)) <= counted * Fraction(1001, 1000)


def sine_power(exponent: float, largest: int = 64) -> tuple[ir.Expr | None, Values]:
    values = Values(function="f", line=9)
    given: dict[str, Value] = {name: values.intern(ir.Var(VEC3, name)) for name in "nw"}
    given["p"] = constant(values, exponent)
    return sine_powers.whole_sine_exponents(largest)(values, function(SINE), given), values


POINTS = (
    ((1, 0, 0), (Fraction(3, 5), Fraction(4, 5), 0), Fraction(4, 5)),
    ((0, 1, 0), (0, Fraction(3, 5), Fraction(-4, 5)), Fraction(4, 5)),
    ((0, 0, 1), (Fraction(4, 5), 0, Fraction(-3, 5)), Fraction(4, 5)),
    ((Fraction(1, 3), Fraction(2, 3), Fraction(2, 3)), (0, Fraction(3, 5), Fraction(4, 5)), Fraction(5, 15)),
)
"""Two directions whose sine is a fraction; the last one's cosine is 14 / 15, whose sine is no fraction."""


@pytest.mark.parametrize("exponent", [1, 2, 3, 4, 5, 7, 24])
def test_powers_of_a_sine(exponent: int) -> None:
    made, _ = sine_power(float(exponent))
    assert made is not None
    for n, w, sine in POINTS[:3]:
        for first, second in ((n, w), (w, n)):
            assert value_of(made, {"n": first, "w": second}) == sine**exponent
    if exponent % 2 == 0:
        along, leaning, _ = POINTS[3]
        assert value_of(made, {"n": along, "w": leaning}) == Fraction(29, 225) ** (exponent // 2)


def test_first_power_of_a_sine_is_half_the_area_of_sum_and_difference() -> None:
    """Of vectors of any length: the root of what is left without cancellation."""
    made, _ = sine_power(1.0)
    assert made is not None
    for first, second, area in (
        ((1, 2, 2), (2, 1, -2), 9),
        ((1, 0, 0), (0, 3, 4), 5),
        ((2, 3, 6), (6, 2, -3), 49),
    ):
        assert value_of(made, {"n": first, "w": second}) == area
    assert value_of(made, {"n": (1, 2, 2), "w": (1, 2, 2)}) == 0


def test_higher_powers_end_above_denormal_numbers() -> None:
    for exponent in (2, 4, 24):
        made, _ = sine_power(float(exponent))
        assert made is not None
        least = value_of(made, {"n": (1, 0, 0), "w": (1, 0, 0)})
        assert least > 0
        assert least < Fraction(2) ** -49
        assert least * value_of(made, {"n": (1, 0, 0), "w": (2, 0, 0)}) == least**2
        assert least > Fraction(2) ** -101


SAID = {
    1: ("a root", "1.1e-06"),
    2: ("no multiplication", "1.2e-06"),
    3: ("1 multiplication and a root", "1.8e-06"),
    4: ("1 multiplication", "2.4e-06"),
    5: ("2 multiplications and a root", "3e-06"),
    24: ("4 multiplications", "1.4e-05"),
    25: ("5 multiplications and a root", "1.5e-05"),
}
"""What is told: 9, 10, 15, 20, 25, 120 and 125 times 2^-23."""


@pytest.mark.parametrize("exponent", SAID)
def test_what_is_told_of_a_sine(exponent: int) -> None:
    _, values = sine_power(float(exponent))
    said, error = SAID[exponent]
    why = f"absolute error at most {error} (either-way rounding)"
    assert values.log == [Step("powers", f"{SINE}(n, w, {exponent}) -> {said}", why, "f:9")]


@pytest.mark.parametrize(("exponent", "counted"), [(1, 9), (2, 10), (3, 15), (4, 20), (24, 120), (101, 505)])
def test_error_of_a_sine_is_counted_in_roundings(exponent: int, counted: int) -> None:
    """Four roundings of the square, doubled, times the slope p / 2 or 1; one more for each factor."""
    assert sine_powers.error(exponent) == counted * 2.0**-23


def test_other_sines_stay_calls() -> None:
    for exponent, largest in ((0.0, 64), (0.5, 64), (65.0, 64), (3.0, 2)):
        made, values = sine_power(exponent, largest)
        assert made is None
        assert not values.log
    values = Values()
    n, two = values.intern(ir.Var(VEC3, "n")), constant(values, 2.0)
    rule = sine_powers.whole_sine_exponents(64)
    assert rule(values, function("shell_sine"), {"n": n, "w": n, "p": two}) is None
    assert rule(values, function(SINE), {"n": {"part": n}, "w": n, "p": two}) is None
    assert rule(values, function(SINE), {"n": n, "w": {"part": n}, "p": two}) is None
    assert rule(values, function(SINE), {"n": n, "w": n, "p": n}) is None


def test_every_exponent_is_known_by_its_argument() -> None:
    expected = {**{name: power for name, (_, power, _) in TABLE.items()}, SINE: "p"}
    assert dict(sine_powers.EXPONENTS) == expected
    assert [p.name for p in load_library().function(SINE).parameters] == ["n", "w", "p"]
