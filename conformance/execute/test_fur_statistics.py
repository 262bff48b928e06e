"""Fur on every target against brute force: fields of truncated cones, and tufts of scattered tangents.

Plan. On the device in float32:
  opacity     hair area -> optical depth -> opacity equals the share of rays that real cones block
  highlight   average -> softened exponent -> specular equals the mean specular over scattered tangents
  exactness   f_dir is rho where both rho agree, bit for bit; hair + skin weight never exceed 1
"""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.library import load_library
from conformance import cases
from conformance.statistics.device import device_call, rounded_unit
from conformance.statistics.evaluator import Array, view
from conformance.statistics.hair_field import Hairs, Opacity, field_opacity
from conformance.statistics.tangent_field import pair_of_directions, scattered_tangents
from targets import TimedRuntime

CHECKS: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("scene_statistics.toml").read_text(encoding="utf-8")
)["fur"]
SEED = 19_970_803


@cache
def cones(row: tuple[float, ...]) -> Opacity:
    """Opacity of a field of cones; measured once for all targets."""
    check = CHECKS["cones"]
    hairs = Hairs(row[0], row[1], row[2], row[3], view(row[4], row[5]))
    return field_opacity(hairs, view(row[6], row[7]), check["fields"], check["rays"], SEED)


@pytest.mark.parametrize("row", CHECKS["cones"]["rows"])
def test_opacity_is_that_of_cones(runtime: TimedRuntime, row: list[float]) -> None:
    call, check = device_call(load_library(), runtime), CHECKS["cones"]
    density, *shape = (np.array([x]) for x in row[:4])
    area = call("fur_hair_area", dict(zip(("hair_length", "radius_base", "radius_tip"), shape, strict=True)))
    t, w = view(row[4], row[5])[None], view(row[6], row[7])[None]
    n = np.array([[0.0, 0.0, 1.0]])
    inputs = {"density": density, "hair_area": area, "t": t, "n": n, "w": w}
    depth = call("fur_optical_depth", inputs)
    opacity = call("fur_opacity", {"optical_depth": depth})[0]
    measured = cones(tuple(row))
    print(f"seed {SEED}: cones {measured.mean:.4f} +- {measured.standard_error:.4f}, device {opacity:.4f}")
    allowed = check["standard_errors"] * measured.standard_error + check["model"]
    assert abs(measured.mean - opacity) <= allowed


def specular(call: Any, t: Array, l: Array, v: Array, exponent: Array) -> Array:
    """strand_specular on the device for rows of inputs."""
    return np.asarray(call("strand_specular", {"t": t, "l": l, "v": v, "exponent": exponent}))


@pytest.mark.parametrize("row", CHECKS["scattered_tangents"]["rows"])
def test_softened_highlight_is_that_of_scattered_tangents(runtime: TimedRuntime, row: list[float]) -> None:
    check, call = CHECKS["scattered_tangents"], device_call(load_library(), runtime)
    mean_length, exponent, largest = row
    tangents = scattered_tangents(mean_length, check["count"], SEED)
    average = call("fur_average", {"tangent_mean": np.array([[0.0, 0.0, mean_length]])})
    worst = 0.0
    for kappa in check["kappas"]:
        soft = call(
            "fur_soft_exponent",
            {
                "exponent": np.array([exponent]),
                "variance": average["variance"],
                "azimuth_cosine": np.array([kappa]),
            },
        )[0]
        for cone in check["cones"]:
            for delta in np.linspace(-1.0, 1.0, check["offsets"]):
                l, v = pair_of_directions(cone + delta / 2.0, delta / 2.0 - cone, kappa)
                l, v = rounded_unit(l), rounded_unit(v)
                many = len(tangents)
                rows = (np.tile(l, (many, 1)), np.tile(v, (many, 1)), np.full(many, exponent))
                truth = specular(call, tangents, *rows).mean()
                peak = specular(call, average["tangent"], l[None], v[None], np.array([soft]))[0]
                worst = max(worst, abs(float(np.sqrt(soft / exponent) * peak - truth)))
    print(f"seed {SEED}: |m| {mean_length}, exponent {exponent}: {worst:.4f}")
    assert worst <= largest * check["slack"]


def test_equal_reflectances_come_through_unchanged(runtime: TimedRuntime) -> None:
    call, library = device_call(load_library(), runtime), load_library()
    points = cases.load("equal_attenuations")
    uniform = cases.draw(library.function("fur_directional_attenuation"), "uniform", 100_000, SEED)
    uniform["rho_transmit"] = uniform["rho_reflect"]
    for inputs in (points, uniform):
        got = call("fur_directional_attenuation", inputs)
        np.testing.assert_array_equal(got, np.asarray(inputs["rho_reflect"], np.float64))


@pytest.mark.parametrize("family", ["uniform", "depth_pairs", "lopsided_depths"])
@pytest.mark.parametrize("name", ["fur_weights_slab", "fur_weights_goldman"])
def test_weights_share_the_light(runtime: TimedRuntime, name: str, family: str) -> None:
    library = load_library()
    weights = device_call(library, runtime)(name, cases.draw(library.function(name), family, 50_000, SEED))
    assert (weights["hair"] >= 0.0).all()
    assert (weights["skin"] >= 0.0).all()
    assert (weights["hair"] + weights["skin"]).max() <= 1.0 + CHECKS["weights"]["excess"]
