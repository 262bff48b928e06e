"""Specialised functions on every target: a driver computes permitted results of the general function.

Plan. A scene's worth of knowledge (constants, an alias, ranges, facts that the inputs keep) about the whole
fur shader, specialised by the exact passes; the device's results lie in the intervals that the target's
table permits the general function. Whole exponents by multiplication stay within their stated error. Arrays
are loaded, numbered by a loop and by a table, as parameters and as constants, in every form of kernel.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from codegen.execute import execute
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.kernels import KernelOptions
from codegen.library import load_library
from codegen.passes.rules.powers import error
from codegen.passes.specialise import specialise
from conformance.cases.drawing import draw
from conformance.unit.support import lights
from targets import TimedRuntime

LIBRARY = load_library()
LANES = 4096
SEED = 20_122


def column(value: Any) -> Any:
    assert not isinstance(value, dict)
    return value


def test_fur_of_a_scene_is_permitted(runtime: TimedRuntime) -> None:
    name = "fakefur_shade"
    made = specialise(
        LIBRARY,
        name,
        constants={"optics.rho_surface": 0.0, "coat.radius_tip": 0.01, "optics.overlap": 0.5},
        aliases={"optics.rho_transmit": "optics.rho_reflect"},
        ranges={"optics.exponent": (4.0, 200.0)},
        facts=[("dot(n, v)", 0.05, 1.0)],
        new_name="scene_fur",
    )
    assert {"ranges", "identities", "dead"} <= {step.name for step in made.log}
    inputs = draw(LIBRARY.function(name), "uniform", LANES, SEED)
    inputs["optics"]["exponent"] = np.clip(inputs["optics"]["exponent"], 4.0, 200.0)
    inputs = made.impose(inputs)
    facing = np.einsum("nk,nk->n", inputs["n"], inputs["v"])
    inputs["v"] = np.where(facing[:, None] < 0.0, -inputs["v"], inputs["v"])
    keeps = np.abs(facing) >= 0.06
    got = execute(LIBRARY.with_functions([made.function]), "scene_fur", made.arguments(inputs), runtime)
    allowed = permitted(LIBRARY, name, inputs, DEFAULT_TABLES[runtime.device.target])
    assert (allowed.contains(got) | ~keeps).all()
    assert (allowed.guaranteed & keeps).any()


def test_product_of_a_whole_exponent_errs_as_stated(runtime: TimedRuntime) -> None:
    made = specialise(LIBRARY, "pow_one_minus", constants={"p": 24.0}, new_name="power_24", powers=64)
    q = np.linspace(0.0, 0.9, LANES).astype(np.float32)
    got = column(execute(LIBRARY.with_functions([made.function]), "power_24", {"q": q}, runtime))
    exact = (1.0 - q.astype(np.float64)) ** 24
    assert (np.abs(got - exact) <= error(24, 1) * exact).all()


@pytest.mark.parametrize(
    "options",
    [KernelOptions(), KernelOptions(source="literal"), KernelOptions(form="pair")],
    ids=["words", "literals", "pair"],
)
def test_arrays_are_numbered(runtime: TimedRuntime, options: KernelOptions) -> None:
    extended = LIBRARY.with_functions([lights.lambert_sum()])
    colour = [[1.0, 0.5, 0.25]] * lights.LIGHTS
    table = specialise(extended, lights.NAME, constants={"light": colour}, new_name="table_sum")
    extended = extended.with_functions([table.function])
    inputs = {name: a[: 2 if options.source == "literal" else None] for name, a in lights.inputs().items()}
    judge = DEFAULT_TABLES[runtime.device.target]
    for name, given in ((lights.NAME, inputs), ("table_sum", table.arguments(inputs))):
        got = execute(extended, name, given, runtime, options=options)
        allowed = permitted(extended, name, given, judge)
        assert allowed.guaranteed.all()
        assert allowed.contains(got).all(), name
