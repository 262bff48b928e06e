"""Intervals reproduce known figures, and tell what is permitted from what is not.

Plan.
  figures    square roots, powers, 1 - e^-x and three forms of a sine have the known permitted errors
  drivers    SwiftShader's sine is permitted by WGSL and Vulkan, not by OpenCL; three times its error by none
  causes     a power of 0, a division by 0 and a root of a negative number are anything, and say why
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import permitted
from conformance.unit.support.sources import library_of

DATA: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("interval_figures.toml").read_text(encoding="utf-8")
)


def deviation(
    folder: Path, text: str, parameters: str, inputs: dict[str, Any], table: str, measure: str
) -> float:
    """The largest distance of a permitted result from the exact one; infinite where anything is permitted."""
    library = library_of(folder, f"def probe({parameters}) -> f32:\n    return {text}\n")
    found: Any = permitted(library, "probe", inputs, table)
    if not found.guaranteed.all():
        return float("inf")
    exact: Any = evaluate(library, "probe", inputs, "float64")
    largest = np.maximum(np.abs(found.low - exact), np.abs(found.high - exact))
    return float((largest / np.abs(exact) if measure == "relative" else largest).max())


@pytest.mark.parametrize("figure", DATA["figure"], ids=lambda f: f"{f['text']} {f['inputs']}")
def test_known_figure(figure: dict[str, Any], tmp_path: Path) -> None:
    names = "ab"[: len(figure["inputs"])]
    inputs = {n: np.array([x], np.float32) for n, x in zip(names, figure["inputs"], strict=True)}
    parameters = ", ".join(f"{n}: X" for n in names)
    found = deviation(tmp_path, figure["text"], parameters, inputs, figure["table"], figure["measure"])
    assert figure["low"] <= found <= figure["high"], figure["origin"]


@pytest.mark.parametrize("form", DATA["sine"]["forms"])
def test_forms_of_a_sine(form: str, tmp_path: Path) -> None:
    sine = DATA["sine"]
    for angle, known in zip(sine["angles"], sine["forms"][form], strict=True):
        t = np.array([[np.cos(1.0), np.sin(1.0) * 0.6, np.sin(1.0) * 0.8]])
        across = np.array([[-np.sin(1.0), np.cos(1.0) * 0.6, np.cos(1.0) * 0.8]])
        inputs = {
            "a": t.astype(np.float32),
            "b": (np.cos(angle) * t + np.sin(angle) * across).astype(np.float32),
        }
        found = deviation(tmp_path, form, "a: V, b: V", inputs, "wgsl", "relative")
        if np.isinf(known):
            assert found > 1.0, angle
        else:
            assert known / sine["factor"] <= found <= known * sine["factor"], (angle, found)


def test_poor_sine_is_permitted_where_the_specification_permits_it(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def probe(a: X) -> f32:\n    return sin(a)\n")
    x = np.linspace(-3.1, 3.1, 1001).astype(np.float32)
    exact = np.sin(x.astype(np.float64))
    error = DATA["swiftshader_sine"]["error"]
    poor = (exact + error).astype(np.float32)
    for table, expected in (("wgsl", True), ("vulkan", True), ("glsl", True), ("opencl", False)):
        assert bool(permitted(library, "probe", {"a": x}, table).contains(poor).all()) is expected, table
        assert (
            not permitted(library, "probe", {"a": x}, table)
            .contains((exact + 3.0 * error).astype(np.float32))
            .any()
        )


ANYTHING = {
    "exp2(2.0 * log2(a))": (0.0, "probe: log2 of x: x may be 0 or less"),
    "1.0 / a": (0.0, "probe: / of y: the divisor may be 0"),
    "1.0 / (a * 1.2e-38)": (0.5, "probe: / of y: the divisor may be 0"),
    "sqrt(a)": (-1.0, "probe: sqrt of x: x may be negative"),
    "inverse_sqrt(a)": (0.0, "probe: inverse_sqrt of x: x may be 0 or less"),
    "exp(a)": (89.0, "probe: exp: the result may overflow"),
    "sin(a)": (3.2, "probe: sin of x: x may lie outside the promised interval"),
    "a * a": (1e20, "probe: *: the result may overflow"),
    "f32(i32(a))": (3e9, "probe: i32() of x: outside the integers of the type"),
    "2.0 / a": (2e38, "probe: / of y: outside the promised magnitudes"),
    "min(1.0 / a, 1.0)": (0.0, "probe: / of y: the divisor may be 0"),
}


@pytest.mark.parametrize("text", ANYTHING)
def test_cause_is_named(text: str, tmp_path: Path) -> None:
    value, cause = ANYTHING[text]
    library = library_of(tmp_path, f"def probe(a: X) -> f32:\n    return {text}\n")
    found: Any = permitted(library, "probe", {"a": np.array([value, 1.0], np.float32)}, "wgsl")
    assert found.guaranteed.tolist() == [False, True]
    assert found.cause(0).endswith(cause)
    assert found.contains(np.array([np.nan, 1.0], np.float32))[0]
