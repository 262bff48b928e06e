"""Results that only an interpolation in its other form explains, and sums that are none."""

from pathlib import Path

import numpy as np
import pytest

from codegen.intervals import permitted
from conformance.programs.interpolated import interpolated, weighted
from conformance.programs.rearranged import explained
from conformance.unit.support.sources import library_of

MIXED = """def probe(c: X, a: X, b: X) -> f32:
    return {sum}
"""


@pytest.mark.parametrize(
    "sum_",
    [
        "(1.0 - c) * a + c * b",
        "b * c + a * (1.0 - c)",
        "c * b + (1.0 - c) * a",
        "a * (1.0 - c) + c * b",
        "(1.0 + -c) * a + c * b",
        "c * b + a * (-c + 1.0)",
    ],
)
def test_factored_interpolation_is_explained(sum_: str, tmp_path: Path) -> None:
    """Softpipe's poulin_fournier_pdf where specular is just below 1."""
    library = library_of(tmp_path, MIXED.format(sum=sum_))
    below_one, third = np.float32(1.0 - 2.0**-24), np.float32(0.318309873)
    inputs = {"c": np.array([below_one]), "a": np.array([third]), "b": np.array([0.0], np.float32)}
    got = np.array([third + below_one * (np.float32(0.0) - third)], np.float32)
    assert got[0] == 2.0**-25
    assert not permitted(library, "probe", inputs, "glsl").contains(got).any()
    assert explained(library, "probe", inputs, "glsl", got).all()
    assert not explained(library, "probe", inputs, "glsl", 4.0 * got).any()
    assert not explained(library, "probe", inputs, "opencl", got).any()


ONE_STEP = np.float32(2.0**-24)
"""Between neighbours in [0.5, 1)."""


@pytest.mark.parametrize(
    "sum_",
    [
        "a * (1.0 + -b) + b",
        "b + a * (1.0 - b)",
        "(-b + 1.0) * a + b",
        "b + (1.0 + -b) * a",
        "c + a * (1.0 - c)",
    ],
)
def test_distributed_interpolation_is_explained(sum_: str, tmp_path: Path) -> None:
    """Llvmpipe's shell_shadow with a + (-b) for a - b: (1 - s_min) height + s_min."""
    library = library_of(tmp_path, MIXED.format(sum=sum_))
    height, s_min = (np.array([word], np.uint32).view(np.float32) for word in (0x3F56E6B2, 0x3EAEF45F))
    inputs = {"a": s_min, "b": height, "c": height}
    got = (np.float32(1.0) - s_min) * height + s_min
    assert got[0] == np.float32(0.8943161964416504)
    assert not permitted(library, "probe", inputs, "glsl").contains(got).any()
    assert explained(library, "probe", inputs, "glsl", got).all()
    assert not explained(library, "probe", inputs, "opencl", got).any()
    for wrong in (got - 2 * ONE_STEP, got + 5 * ONE_STEP):
        assert not explained(library, "probe", inputs, "glsl", wrong).any()


def test_a_slope_from_one_end_to_another_is_distributed(tmp_path: Path) -> None:
    """a + c (b - a) is (1 - c) a + c b."""
    source = MIXED.format(sum="(b - a) * c + a")
    given = library_of(tmp_path, source).function("probe")
    wanted = MIXED.format(sum="(1.0 - c) * a + c * b")
    (tmp_path / "wanted").mkdir()
    assert weighted(given).body == library_of(tmp_path / "wanted", wanted).function("probe").body


@pytest.mark.parametrize("sum_", ["a + c * (a - b)", "a + c * (b - c)", "a - c * (b - a)", "a + c * (b + a)"])
def test_other_slopes_are_not_distributed(sum_: str, tmp_path: Path) -> None:
    function = library_of(tmp_path, MIXED.format(sum=sum_)).function("probe")
    assert weighted(function) == function


@pytest.mark.parametrize("sum_", ["(1.0 - c) * a + b * b", "(2.0 - c) * a + c * b", "(1.0 + c) * a + c * b"])
def test_other_sums_are_no_interpolations(sum_: str, tmp_path: Path) -> None:
    function = library_of(tmp_path, MIXED.format(sum=sum_)).function("probe")
    assert interpolated(function) == function
