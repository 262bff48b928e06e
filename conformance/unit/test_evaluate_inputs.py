"""What goes into the evaluator and between its kinds of numbers.

Plan.
  conversions  floats become whole numbers by cutting off, up to the ends of both types, in every arithmetic;
               those beyond the ends of u32 and of halves give what IEEE 754 and two's complement say
  ends         whole numbers go in up to the ends of their types
  repeated     a single value stands for all lanes
  shapes       a scalar of a wrong shape gets one sentence, as a vector does
  multiprecision  inputs are exact there, and so is what follows
"""

from __future__ import annotations

import warnings
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.evaluate.arrays import ARITHMETICS, convert_inputs
from codegen.evaluate.arrays import arithmetic as find_arithmetic
from codegen.ir.types import F32, VEC3, Type
from codegen.passes.half import HalfRules
from conformance.unit.support.sources import library_of

CUT_OFF = {
    "u32": ([0.0, 0.75, 2.5, 3e9, 4294967040.0], [0, 0, 2, 3_000_000_000, 4_294_967_040]),
    "i32": ([-2.75, -0.5, 0.5, 7.9, -2147483648.0, 2147483520.0], [-2, 0, 0, 7, -(2**31), 2_147_483_520]),
}


@pytest.mark.parametrize("arithmetic", ARITHMETICS)
@pytest.mark.parametrize("type_", CUT_OFF)
def test_floats_are_cut_off(type_: str, arithmetic: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, f"def probe(x: X) -> {type_}:\n    return {type_}(x)\n")
    given, expected = CUT_OFF[type_]
    found: Any = evaluate(library, "probe", {"x": np.array(given, np.float32)}, arithmetic)
    assert [int(k) for k in found] == expected
    assert np.asarray(found).dtype == {"u32": np.uint32, "i32": np.int32}[type_]


@pytest.mark.parametrize("arithmetic", ["float32", "float64"])
def test_floats_beyond_a_u32_are_taken_modulo_its_size(arithmetic: str, tmp_path: Path) -> None:
    """Sources avoid them; yet whichever processor evaluates, a lane that is not taken has the same bits."""
    library = library_of(tmp_path, "def probe(x: X) -> u32:\n    return u32(x)\n")
    x = np.array([-1.0, -2.75, 2.0**32, 3.0 * 2.0**31, -(2.0**33) - 1024.0], np.float32)
    found: Any = evaluate(library, "probe", {"x": x}, arithmetic)
    assert found.tolist() == [2**32 - 1, 2**32 - 2, 0, 2**31, 2**32 - 1024]


@pytest.mark.parametrize(
    ("type_", "expected"),
    [("u32", [0, 0, 2**32 - 1, 2**32 - 1, 0, 0, 0]), ("i32", [-(2**31), -7, 7, 2**31 - 1, 0, 0, 0])],
)
def test_multiprecision_goes_to_the_ends_of_whole_numbers(
    type_: str, expected: list[int], tmp_path: Path
) -> None:
    """What is infinite, or no number at all, becomes 0: no branch takes such a lane."""
    library = library_of(tmp_path, f"def probe(x: X, y: X) -> {type_}:\n    return {type_}(x / y)\n")
    x = np.array([-3e9, -7.5, 7.5 if type_ == "i32" else 4294967295.5, 5e9, 1.0, -1.0, 0.0])
    y = np.array([1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    found: Any = evaluate(library, "probe", {"x": x, "y": y}, "mpmath")
    assert found.tolist() == expected


def test_numbers_beyond_the_largest_half_become_infinite_without_a_warning(tmp_path: Path) -> None:
    library = library_of(tmp_path, 'def probe(x: X) -> f32:\n    """F."""\n    return -x\n')
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found: Any = evaluate(library, "probe", {"x": [65504.0, 1e6, -1e6]}, "float16", rules=HalfRules())
    assert found.tolist() == [-65504.0, -np.inf, np.inf]


ENDS = {"u32": (0, 2**32 - 1), "i32": (-(2**31), 2**31 - 1)}


@pytest.mark.parametrize("type_", ENDS)
def test_whole_numbers_go_in_up_to_their_ends(type_: str, tmp_path: Path) -> None:
    library = library_of(tmp_path, f"def probe(n: {type_}) -> {type_}:\n    return n\n")
    low, high = ENDS[type_]
    found: Any = evaluate(library, "probe", {"n": [low, high]})
    assert found.tolist() == [low, high]
    for beyond in (low - 1, high + 1):
        with pytest.raises(UserError) as caught:
            evaluate(library, "probe", {"n": [0, beyond]})
        assert str(caught.value) == f"probe: n holds a number outside [{low}, {high}]"


def test_single_values_are_repeated_for_all_lanes_unless_one_is_enough() -> None:
    """What goes to a device is whole; the evaluator keeps one lane of what all lanes share."""
    types: dict[str, Type] = {"x": F32, "v": VEC3}
    given = {"x": [1.0, 2.0], "v": [3.0, 4.0, 5.0]}
    whole, count = convert_inputs(types, given, find_arithmetic("float32"), "probe")
    kept, same = convert_inputs(types, given, find_arithmetic("float32"), "probe", repeated=False)
    assert count == same == 2
    assert np.asarray(whole["v"]).tolist() == [[3.0, 4.0, 5.0]] * 2
    assert np.asarray(kept["v"]).tolist() == [[3.0, 4.0, 5.0]]
    assert np.asarray(whole["x"]).tolist() == np.asarray(kept["x"]).tolist() == [1.0, 2.0]


def test_scalar_of_a_wrong_shape(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X, v: V) -> f32:\n    return x * v.x\n")
    one, pairs = np.ones(3, np.float32), np.ones((3, 2), np.float32)
    with pytest.raises(UserError, match=r"x has shape \(3, 2\), but f32 needs \(N,\)$"):
        evaluate(library, "probe", {"x": pairs, "v": np.ones((3, 3), np.float32)})
    with pytest.raises(UserError, match=r"v has shape \(3, 2\), but vec3 needs \(N, 3\)$"):
        evaluate(library, "probe", {"x": one, "v": pairs})


def test_multiprecision_takes_inputs_as_they_are(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X) -> f32:\n    return x / 3.0\n")
    x = np.array([0.1, 1.0], np.float32)
    with mpmath.workdps(40):
        found: Any = evaluate(library, "probe", {"x": x}, "mpmath")
        assert all(isinstance(value, mpmath.mpf) for value in found)
        assert [value * 3 - mpmath.mpf(float(given)) for value, given in zip(found, x, strict=True)] == [0, 0]
        assert found[1] != mpmath.mpf(1.0 / 3.0)


def test_multiprecision_takes_its_own_numbers_whole(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(x: X, v: V) -> f32:\n    return x * v.z\n")
    with mpmath.workdps(60):
        third = mpmath.mpf(1) / 3
        inputs = {"x": np.array([third, 2 * third]), "v": [[0, 0, third]]}
        found: Any = evaluate(library, "probe", inputs, "mpmath")
        assert list(found) == [third * third, 2 * third * third]


@pytest.mark.parametrize("text", ["0.1", "min(0.1, 3.0)", "x if x < 2.0 else 0.5", "f32(u32(x))"])
def test_multiprecision_gives_its_own_numbers(text: str, tmp_path: Path) -> None:
    """Also where nothing is calculated with a constant."""
    library = library_of(tmp_path, f"def probe(x: X) -> f32:\n    return {text}\n")
    found: Any = evaluate(library, "probe", {"x": [1.0, 3.0]}, "mpmath")
    assert all(isinstance(value, mpmath.mpf) for value in found)


@pytest.mark.parametrize("text", ["x * x * x", "x - x * x", "x * v.y * v.z", "min(x, v.x) * x * x"])
def test_multiprecision_rounds_nothing_of_inputs_alone(text: str, tmp_path: Path) -> None:
    """Products of three float32 numbers leave a double's 53 bits."""
    library = library_of(tmp_path, f"def probe(x: X, v: V) -> f32:\n    return {text}\n")
    x, v = np.array([0.1, 1.0 / 3.0], np.float32), np.array([[0.7, 0.3, 1.1]] * 2, np.float32)
    with mpmath.workdps(60):
        found: Any = evaluate(library, "probe", {"x": x, "v": v}, "mpmath")
        lanes = [Fraction(float(value)) for value in x]
        parts = [Fraction(float(value)) for value in v[0]]
        wanted = {
            "x * x * x": [a * a * a for a in lanes],
            "x - x * x": [a - a * a for a in lanes],
            "x * v.y * v.z": [a * parts[1] * parts[2] for a in lanes],
            "min(x, v.x) * x * x": [min(a, parts[0]) * a * a for a in lanes],
        }[text]
        for got, exact in zip(found, wanted, strict=True):
            assert got * exact.denominator == exact.numerator
