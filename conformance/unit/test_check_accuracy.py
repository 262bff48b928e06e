"""The accuracy beside the verdicts: which measure a function gets, and what each measure says.

Plan.
  choice  every public function has a measure that fits its result; shades have code steps as well
  errors  each measure on known numbers: ULP, relative with floor and by the largest component, code steps
  figures maximum, p99.9, median and the worst input are those of the lanes that count
"""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import Any

import numpy as np
import pytest

from codegen.ir.types import Struct
from codegen.library import load_library
from conformance.check import accuracy
from conformance.check.accuracy import CODE_STEPS, DIFFERENCE, RELATIVE, ULP, Accuracy, error, measures_of
from conformance.check.draws import draw
from conformance.check.sample import together
from conformance.picture.tone import srgb_decode
from conformance.unit.support.tolerances import floor, tolerance

FLOOR = 0.5 / (255.0 * 12.92)
"""Half a step of an 8-bit sRGB code at black."""


@pytest.mark.parametrize(
    ("name", "measures"),
    [
        ("bessel_i0e", [ULP]),
        ("coat_extinction", [ULP]),
        ("sin_angle", [RELATIVE]),
        ("half_vector", [RELATIVE]),
        ("ggx_pdf", [RELATIVE]),
        ("pcg3d", [DIFFERENCE]),
        ("radical_inverse_base2", [DIFFERENCE]),
        ("unit_float", [RELATIVE]),
        ("kajiya_kay_shade", [RELATIVE, CODE_STEPS]),
        ("fur_opacity", [ULP, CODE_STEPS]),
        ("fur_weights_slab", [RELATIVE, CODE_STEPS]),
    ],
)
def test_measure_fits_the_function(name: str, measures: list[str]) -> None:
    assert [a.measure for a in measures_of(load_library().function(name))] == measures


def test_shades_are_named_by_functions_that_exist() -> None:
    public = load_library().public
    table = accuracy._table()
    assert table["relative"]["floor"] == pytest.approx(FLOOR, rel=tolerance("two_digits"))
    for glob in table["shades"]["functions"]:
        found = [name for name in public if fnmatchcase(name, glob)]
        assert found, glob
        for name in found:
            returns = load_library().function(name).returns
            assert isinstance(returns, Struct) or getattr(returns, "element", returns).name == "f32"


def f32(*values: Any) -> Any:
    return np.array(values, np.float32)


def f64(*values: Any) -> Any:
    return np.array(values, np.float64)


@pytest.mark.parametrize(
    ("measure", "got", "expected", "errors"),
    [
        (ULP, f32(1.0, 1.0 + 2.0**-23, 0.0), f64(1.0, 1.0, 0.0), [0.0, 1.0, 0.0]),
        (ULP, f32(np.inf), f64(1.0), [np.inf]),
        (RELATIVE, f32(1.5, 0.0, 0.0), f64(1.0, 1.0, 1e-4), [0.5, 1.0, 1e-4 / 1.5e-4]),
        (RELATIVE, f32([3.0, 0.5], [1.0, 1.0]), f64([4.0, 0.0], [1.0, 1.0]), [0.25, 0.0]),
        (DIFFERENCE, np.array([7, 2**32 - 1], np.uint32), np.array([9, 2**32 - 1], np.uint32), [2.0, 0.0]),
        (CODE_STEPS, srgb_decode(f64(0.5, 1.0)).astype(np.float32), srgb_decode(f64(0.5, 0.9)), [0.0, 25.5]),
        (CODE_STEPS, f32(3.0, -1.0), f64(2.0, 0.0), [0.0, 0.0]),
        (RELATIVE, {"a": f32(2.0), "b": f32(1.0)}, {"a": f64(2.0), "b": f64(4.0)}, [0.75]),
    ],
    ids=["ULP", "ULP of infinity", "relative", "vectors", "words", "steps", "steps beyond white", "structs"],
)
def test_errors_in_each_measure(measure: str, got: Any, expected: Any, errors: list[float]) -> None:
    smallest = 1.5e-4 if measure == RELATIVE else 0.0
    found = error(Accuracy(measure, smallest), got, expected)
    assert found == pytest.approx(errors, rel=tolerance("errors_of_float32"), abs=floor("errors_of_float32"))


def test_figures_are_of_the_lanes_that_count() -> None:
    function = load_library().function("bessel_i0e")
    sample = together([draw(function, "uniform", 1001, 3)])
    expected = np.ones(1001)
    got = (1.0 + 2.0**-23 * np.arange(1001)).astype(np.float32)
    use = np.arange(1001) != 1000
    (found,) = accuracy.measured(function, sample, got, expected, use)
    assert (found.lanes, found.maximum, found.p999, found.median) == (1000, 999.0, 999.0, 499.0)
    assert f"{sample.inputs['x'][999]:.9g}" in found.worst
    (nothing,) = accuracy.measured(function, sample, got, expected, np.zeros(1001, np.bool_))
    assert (nothing.lanes, nothing.maximum, nothing.worst) == (0, 0.0, "")
