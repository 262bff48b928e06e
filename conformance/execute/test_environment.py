"""Light from environment maps is the same sum on every target: that of the float64 reference.

Plan. Dual-paraboloid maps of 1 to 32 texels along a disc, random on every level, with one texel of 1e5,
black, and one disc white: on every driver
  radiance    random directions, the axes, the rim and its flanks, on, between and beyond the levels
  seam, rim   no lookup reaches the other disc; across the rim nothing jumps, at any level
  estimators  every lobe and estimator; 0, 1 and other numbers of samples, viewers below the surface,
              exponents 1 to 1e4, widths from 1e-3; more samples than 4096 are 4096
The errors are those of shaderlib/environment/bounds.toml, times the largest texel. Without a driver, the
functions in float32; with drivers a normal run takes some of them, since each is a program to compile.
"""

from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.library import load_library
from conformance.textures.environments import (
    CLEAR,
    SIZES,
    corners,
    looks,
    paraboloid,
    single_texel,
)
from conformance.textures.readers import LANES, LOOKS, SEED, estimator_inputs, lobe_parameters, within
from targets import TimedRuntime

BRIGHTEST = 1e30
"""Radiance far beyond any map's: a sum of weights must not overflow."""
LIBRARY = load_library()
ESTIMATORS = [n for n, f in LIBRARY.documented.items() if n.startswith("env_") and "shift" in f.doc.entries]
USUAL = ("env_filtered_phong", "env_guarded_ggx", "env_monte_carlo_strand", "env_grid_poulin_fournier")
"""What a normal run compiles for every driver: each estimator, four lobes."""
SURFACES = [name for name in ESTIMATORS if not name.endswith("_strand")]


def usual(name: str, when: bool) -> Any:
    """A case of a normal run, or a nightly one."""
    return name if when else pytest.param(name, marks=pytest.mark.nightly)


@pytest.mark.parametrize("kind", ["random", "hot"])
@pytest.mark.parametrize("size", SIZES)
def test_radiance(size: int, kind: str, runtime: TimedRuntime) -> None:
    inputs = {"env": paraboloid(size, kind, SEED), **looks(LOOKS, SEED)}
    assert within("env_radiance", inputs, execute(LIBRARY, "env_radiance", inputs, runtime))


def test_radiance_is_permitted(runtime: TimedRuntime) -> None:
    inputs = {"env": paraboloid(8, "random", SEED), **looks(LOOKS, SEED)}
    got = execute(LIBRARY, "env_radiance", inputs, runtime)
    found = permitted(LIBRARY, "env_radiance", inputs, DEFAULT_TABLES[runtime.device.target])
    assert found.contains(got).all()


def test_no_lookup_reaches_the_other_disc(runtime: TimedRuntime) -> None:
    (bound,) = LIBRARY.bounds["env_radiance"]
    inputs: dict[str, Any] = {"env": paraboloid(32, "halves", SEED), **looks(LOOKS, SEED)}
    got = np.asarray(execute(LIBRARY, "env_radiance", inputs, runtime))
    height = inputs["w"][:, 2]
    for far, value in ((height > CLEAR, 1.0), (height < -CLEAR, 0.0)):
        assert far.any()
        assert np.abs(got[far] - value).max() <= bound.bound


def test_nothing_jumps_across_the_rim(runtime: TimedRuntime) -> None:
    (bound,) = LIBRARY.bounds["env_radiance"]
    turns = np.linspace(0.0, 2.0 * np.pi, 64)
    level = np.arange(13).repeat(len(turns)).astype(np.float32)
    above, below = (
        np.stack([np.cos(turns), np.sin(turns), np.full(len(turns), z)], axis=-1).astype(np.float32)
        for z in (1e-7, -1e-7)
    )
    for kind in ("random", "hot"):
        env = paraboloid(32, kind, SEED)
        sides = [
            np.asarray(
                execute(
                    LIBRARY, "env_radiance", {"env": env, "w": np.tile(w, (13, 1)), "lod": level}, runtime
                )
            )
            for w in (above, below)
        ]
        assert np.abs(sides[0] - sides[1]).max() <= bound.bound * env[0].max()


def test_prefiltered(runtime: TimedRuntime) -> None:
    inputs = {"env": paraboloid(32, "random", SEED), "w": looks(LOOKS, SEED)["w"]}
    assert within("env_prefiltered", inputs, execute(LIBRARY, "env_prefiltered", inputs, runtime))


@pytest.mark.parametrize("name", [usual(n, "guarded" not in n) for n in ESTIMATORS])
def test_estimators_in_float32(name: str) -> None:
    inputs = estimator_inputs(name, "random")
    assert within(name, inputs, evaluate(LIBRARY, name, inputs))


@pytest.mark.parametrize("name", [usual(n, n in USUAL) for n in ESTIMATORS])
def test_estimators(name: str, runtime: TimedRuntime) -> None:
    for kind in ("random", "hot", "black"):
        inputs = estimator_inputs(name, kind)
        got = np.asarray(execute(LIBRARY, name, inputs, runtime))
        assert within(name, inputs, got)
        assert kind != "black" or not got.any()
        assert not got[inputs["samples"] == 0].any()
        unlit = (inputs["v"] * inputs["frame"]["normal"]).sum(axis=1) < 0.0
        assert name not in SURFACES or not got[unlit].any()


@pytest.mark.parametrize("name", [usual(n, n in USUAL) for n in ESTIMATORS])
def test_corners_of_the_domain_stay_finite(name: str, runtime: TimedRuntime) -> None:
    brightest = [level * np.float32(BRIGHTEST) for level in paraboloid(8, "random", SEED)]
    inputs = {"env": brightest, **corners(lobe_parameters(name), 10 * LANES, SEED)}
    assert np.isfinite(np.asarray(execute(LIBRARY, name, inputs, runtime))).all()


def test_maps_of_one_texel(runtime: TimedRuntime) -> None:
    name = "env_filtered_phong"
    for env in (single_texel(0.5), paraboloid(1, "random", SEED)):
        inputs = {**estimator_inputs(name, "random"), "env": env}
        assert within(name, inputs, execute(LIBRARY, name, inputs, runtime))


def test_more_samples_than_most_are_most(runtime: TimedRuntime) -> None:
    inputs = {
        name: value
        for name, value in estimator_inputs("env_filtered_phong", "random", 8).items()
        if name != "samples"
    }
    counts = np.resize(np.array([4096, 4097, 2**32 - 1], np.uint32), LANES)
    got = np.asarray(execute(LIBRARY, "env_filtered_phong", {**inputs, "samples": counts}, runtime))
    most = np.full(LANES, 4096, np.uint32)
    same = execute(LIBRARY, "env_filtered_phong", {**inputs, "samples": most}, runtime)
    assert got.any()
    np.testing.assert_array_equal(got, same)
