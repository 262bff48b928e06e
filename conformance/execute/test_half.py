"""Half forms on devices.

Plan. Points inside the range that half.json states, rounded to half on the host:
  WGSL    f16 where the device has shader-f16: within the emulated figure times the factor of
          half/tolerances.toml; without exponentials bit for bit what the emulation gives
  GLSL    mediump, which desktop drivers compute in full precision: within the same figure
  OpenCL  where the device has cl_khr_fp16; else the refusal is one sentence
"""

import tomllib
from pathlib import Path

import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.half import half_forms
from codegen.library import load_library
from conformance.check import measure
from conformance.half import executed, survey
from targets import TimedRuntime

TOLERANCES = tomllib.loads((Path(survey.__file__).parent / "tolerances.toml").read_text("utf-8"))
USABLE = [name for name, form in half_forms(load_library()).items() if not form.refused]
QUICK = (
    "sin_angle",
    "one_minus_exp_neg",
    "strand_specular_gauss",
    "frame_from_normal",
    "fur_weights_slab",
    "mirror",
)
EXACT = ("sin_angle", "mirror", "frame_from_normal", "strand_azimuth_cosine")
"""Functions of + - * / and sqrt alone."""


def skip_without_halves(runtime: TimedRuntime) -> None:
    if runtime.device.target == "opencl" and not runtime.half_arithmetic:
        with pytest.raises(UserError, match="no half arithmetic"):
            execute(
                load_library(), "mirror", {"l": [0, 0, 1], "n": [0, 0, 1]}, runtime, options=executed.HALF
            )
        pytest.skip(f"{runtime.device.device} has no cl_khr_fp16")
    if runtime.device.target == "wgsl" and not runtime.half_arithmetic:
        pytest.skip(f"{runtime.device.device} has no shader-f16")


def within(name: str, runtime: TimedRuntime) -> None:
    skip_without_halves(runtime)
    form = half_forms(load_library())[name]
    error = executed.executed_error(load_library(), form, runtime)
    assert error <= form.bounds[0].bound * TOLERANCES["executed"]["factor"]


@pytest.mark.parametrize("name", QUICK)
def test_device_keeps_the_figures(name: str, runtime: TimedRuntime) -> None:
    within(name, runtime)


@pytest.mark.nightly
@pytest.mark.parametrize("name", [name for name in USABLE if name not in QUICK])
def test_device_keeps_all_figures(name: str, runtime: TimedRuntime) -> None:
    within(name, runtime)


@pytest.mark.parametrize("name", EXACT)
def test_device_with_halves_rounds_as_the_emulation(name: str, runtime: TimedRuntime) -> None:
    """Where it keeps denormals; an operation less or more in half precision would show here."""
    if not runtime.half_arithmetic:
        pytest.skip(f"{runtime.device.target} computes in full precision here")
    library = load_library()
    form = half_forms(library)[name]
    sample = survey.half_sample(library, library.function(name), form.single, form.where)
    got = execute(library, name, sample.inputs, runtime, options=executed.HALF)
    kept, strict = (evaluate(library, name, sample.inputs, a) for a in survey.ARITHMETICS)
    inside = sample.inside(dict(form.where or {}))
    for (_, g), (_, k), (_, s) in zip(*map(measure.fields, (got, kept, strict)), strict=True):
        same = (g == k) | (g == s)
        assert same[inside].mean() > 0.99
