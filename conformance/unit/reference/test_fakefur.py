"""The fur references against quadrature, mpmath, fields of cones and scattered tangents."""

import tomllib
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import curve_fit

from conformance.reference import fakefur
from conformance.statistics.evaluator import view
from conformance.statistics.hair_field import Hairs, field_opacity
from conformance.statistics.tangent_field import pair_of_directions, scattered_tangents, tuft_highlight
from conformance.unit.support.tolerances import tolerance

CHECKS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("figures.toml").read_text(encoding="utf-8"))[
    "fakefur"
]
SEED = 20100419


def rows(*values: float) -> list[np.ndarray[Any, np.dtype[np.float64]]]:
    """Scalars as arrays of one row."""
    return [np.array([value]) for value in values]


def test_slab_weights_equal_the_integral() -> None:
    check = CHECKS["quadrature"]
    for depth_view in (1e-10, 1e-3, 0.1, 1.0, 7.0, 88.0, 1e3, 1e9):
        for depth_light in (0.0, 1e-10, 0.5, 3.0, 40.0, 1e4, 1e9):
            total = depth_view + depth_light
            # beyond 40 optical depths the integrand is below 1e-17 of its peak
            end = min(1.0, 40.0 / total)
            value, _ = quad(lambda s, a=depth_view, b=total: a * np.exp(-b * s), 0.0, end, epsrel=1e-12)
            weights = fakefur.fur_weights_slab(*rows(depth_view, depth_light))
            assert abs(weights["hair"][0] - value) <= check["tolerance"], (depth_view, depth_light)
            assert weights["skin"][0] + weights["hair"][0] <= 1.0 + check["tolerance"]


def test_closed_forms_agree_with_mpmath() -> None:
    check = CHECKS["closed_form"]
    with mpmath.workdps(60):
        for depth in np.logspace(-30, 2.5, 66):
            exact = -mpmath.expm1(-mpmath.mpf(float(depth)))
            got = fakefur.fur_opacity(*rows(depth))[0]
            assert abs(got - exact) <= check["tolerance"] * exact, depth
            both = mpmath.mpf(float(depth)) + mpmath.mpf("0.75")
            exact = mpmath.mpf(float(depth)) * -mpmath.expm1(-both) / both
            got = fakefur.fur_weights_slab(*rows(depth, 0.75))["hair"][0]
            assert abs(got - exact) <= check["tolerance"] * exact, depth


def test_slab_weights_reproduce_the_printed_values() -> None:
    check = CHECKS["slab_values"]
    for depth_view, depth_light, expected in check["rows"]:
        got = fakefur.fur_weights_slab(*rows(depth_view, depth_light))["hair"][0]
        assert abs(got - expected) <= check["tolerance"], (depth_view, depth_light, got)


def test_goldman_weights_err_as_documented() -> None:
    check = CHECKS["goldman_error"]
    for depth, expected in zip(check["largest_depth"], check["largest_error"], strict=True):
        x = np.geomspace(1e-4, depth, 400)
        view_depth, light_depth = (a.ravel() for a in np.meshgrid(x, x))
        goldman = fakefur.fur_weights_goldman(view_depth, light_depth, np.full(view_depth.shape, 0.5))
        slab = fakefur.fur_weights_slab(view_depth, light_depth)
        error = float(np.max(np.abs(goldman["hair"] - slab["hair"])))
        assert abs(error - expected) <= check["tolerance"], (depth, error)
        np.testing.assert_array_equal(goldman["skin"], slab["skin"])


def test_slab_weights_are_monotone() -> None:
    x = np.geomspace(1e-6, 1e6, 200)
    grid_view, grid_light = np.meshgrid(x, x, indexing="ij")
    hair = fakefur.fur_weights_slab(grid_view.ravel(), grid_light.ravel())["hair"].reshape(grid_view.shape)
    assert (np.diff(hair, axis=0) >= 0.0).all()
    assert (np.diff(hair, axis=1) <= 0.0).all()
    unlit = fakefur.fur_weights_slab(x, np.zeros_like(x))["hair"]
    np.testing.assert_allclose(unlit, fakefur.fur_opacity(x), rtol=CHECKS["closed_form"]["tolerance"])


@pytest.mark.parametrize("row", CHECKS["cones"]["rows"])
def test_opacity_is_that_of_a_field_of_cones(row: list[float]) -> None:
    check = CHECKS["cones"]
    density, hair_length, radius_base, radius_tip, *angles = row
    tangent, v = view(angles[0], angles[1]), view(angles[2], angles[3])
    hairs = Hairs(density, hair_length, radius_base, radius_tip, tangent)
    measured = field_opacity(hairs, v, check["fields"], check["rays"], SEED)
    area = fakefur.fur_hair_area(*rows(hair_length, radius_base, radius_tip))
    normal = np.array([[0.0, 0.0, 1.0]])
    depth = fakefur.fur_optical_depth(rows(density)[0], area, tangent[None], normal, v[None])
    predicted = fakefur.fur_opacity(depth)[0]
    allowed = check["standard_errors"] * measured.standard_error + check["model"]
    print(
        f"seed {SEED}: cones {measured.mean:.4f} +- {measured.standard_error:.4f}, predicted {predicted:.4f}"
    )
    assert abs(measured.mean - predicted) <= allowed
    printed = fakefur.fur_hair_area_printed(*rows(hair_length, radius_base, radius_tip))
    half_depth = fakefur.fur_optical_depth(rows(density)[0], printed, tangent[None], normal, v[None])
    assert abs(measured.mean - fakefur.fur_opacity(half_depth)[0]) > allowed, (
        "the test must tell the two areas apart"
    )


def softened(mean_length: float, exponent: float, kappa: float, offsets: np.ndarray[Any, Any]) -> Any:
    """The softened, scaled highlight at angles `offsets` from its cone."""
    average = fakefur.fur_average(np.array([[0.0, 0.0, mean_length]]))
    soft = fakefur.fur_soft_exponent(np.array([exponent]), average["variance"], np.array([kappa]))[0]
    return np.sqrt(soft / exponent) * np.maximum(np.cos(offsets), 0.0) ** soft


@pytest.mark.parametrize("row", CHECKS["scattered_tangents"]["rows"])
def test_softened_exponent_follows_scattered_tangents(row: list[float]) -> None:
    check = CHECKS["scattered_tangents"]
    mean_length, exponent, largest, rms = row
    tangents = scattered_tangents(mean_length, check["count"], SEED)
    offsets = np.linspace(-1.0, 1.0, check["offsets"])
    errors = []
    for kappa in check["kappas"]:
        predicted = softened(mean_length, exponent, kappa, offsets)
        for cone in check["cones"]:
            truth = [
                tuft_highlight(
                    tangents, *pair_of_directions(cone + delta / 2.0, delta / 2.0 - cone, kappa), exponent
                )
                for delta in offsets
            ]
            errors.append(predicted - np.array(truth))
    worst, mean = float(np.max(np.abs(errors))), float(np.sqrt(np.mean(np.square(errors))))
    print(f"seed {SEED}: |m| {mean_length}, exponent {exponent}: {worst:.4f} ({mean:.4f})")
    assert worst <= largest * check["slack"]
    assert mean <= rms * check["slack"]


def test_peak_and_width_of_a_front_lit_tuft() -> None:
    check = CHECKS["peak"]
    tangents = scattered_tangents(check["mean_length"], CHECKS["scattered_tangents"]["count"], SEED)
    offsets = np.linspace(-0.3, 0.3, 31)
    truth = [
        tuft_highlight(tangents, *pair_of_directions(0.2, d - 0.2, 1.0), check["exponent"]) for d in offsets
    ]
    (peak, exponent), _ = curve_fit(lambda d, a, p: a * np.cos(d) ** p, offsets, truth, p0=(0.3, 20.0))
    assert abs(peak / check["peak"] - 1.0) <= check["tolerance"]
    assert abs(exponent / check["exponent_of_width"] - 1.0) <= 2.0 * check["tolerance"]


def test_obliquity_at_a_hair_lying_toward_the_eye_depends_on_the_approach() -> None:
    check = CHECKS["grazing_limit"]
    for angle, expected in zip(check["angles"], check["values"], strict=True):
        psi = np.radians(angle)
        step = 1e-5 * np.array([[0.0, np.cos(psi), np.sin(psi)]])
        t, n = np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0]])
        got = fakefur.fur_obliquity(t, n, t + step)[0]
        assert abs(got / expected - 1.0) <= check["tolerance"], angle


def test_surface_attenuation_steps_and_ramps() -> None:
    x = np.linspace(-1.0, 1.0, 20001)
    full = np.ones_like(x)
    step = fakefur.fur_surface_attenuation(x, full, -0.2 * full, 0.6 * full)
    line = np.clip((x + 0.2) / 0.8, 0.0, 1.0)
    check = CHECKS["linear_ramp"]
    assert abs(np.max(np.abs(step - line)) - check["largest"]) <= check["tolerance"]
    equal = fakefur.fur_surface_attenuation(x, full, 0.25 * full, 0.25 * full)
    np.testing.assert_array_equal(equal, np.where(x >= 0.25, 1.0, 0.0))
    np.testing.assert_array_equal(fakefur.fur_surface_attenuation(x, 0.0 * x, 0.25 * full, 0.25 * full), full)


def test_one_alpha_for_everything_errs_as_documented() -> None:
    check = CHECKS["one_alpha"]
    x = np.geomspace(1e-3, 12.0, 300)
    view_depth, light_depth = (a.ravel() for a in np.meshgrid(x, x))
    right = fakefur.fur_weights_goldman(view_depth, light_depth, np.full(view_depth.shape, 0.5))
    alpha = fakefur.fur_opacity(view_depth)
    assert abs(np.max(np.abs((1.0 - alpha) ** 2 - right["skin"])) - check["skin"]) <= 2.0 * check["tolerance"]
    # shadow factor of the hair alone: 1 - alpha(v) / 2 against 1 - alpha(l) / 2
    shadow = np.abs(alpha - fakefur.fur_opacity(light_depth)) / 2.0
    assert abs(np.max(shadow) - check["hair"]) <= check["tolerance"]


def coat(density: float) -> dict[str, Any]:
    """A coat of one row."""
    return {
        "density": np.array([density]), "hair_length": np.array([1.0]), "radius_base": np.array([0.01]),
        "radius_tip": np.array([0.01]),
    }  # fmt: skip


def optics(**changes: float) -> dict[str, Any]:
    """Optics of one row; scalars may be replaced."""
    values = {
        "exponent": 8.0, "rho_reflect": 0.7, "rho_transmit": 0.7, "rho_surface": 0.0, "cos_dark": -0.2,
        "cos_lit": 0.5, "overlap": 0.5,
    }  # fmt: skip
    colours = {"k_diffuse": np.array([[0.5, 0.4, 0.3]]), "k_specular": np.array([[0.2, 0.2, 0.2]])}
    return colours | {key: np.array([value]) for key, value in (values | changes).items()}


@pytest.mark.parametrize("name", ["fakefur_shade", "fakefur_shade_slab", "fakefur_shade_printed"])
def test_bare_and_buried_skin(name: str) -> None:
    t, n = np.array([[0.6, 0.0, 0.8]]), np.array([[0.0, 0.0, 1.0]])
    l, v = np.array([view(30.0, 40.0)]), np.array([view(50.0, 190.0)])
    light, skin = np.array([[2.0, 1.0, 0.5]]), np.array([[0.3, 0.6, 0.9]])
    shade = fakefur.REFERENCES[name]
    closed = CHECKS["closed_form"]["tolerance"]
    np.testing.assert_allclose(shade(coat(0.0), optics(), t, n, l, v, light, skin), light * skin, rtol=closed)
    buried = np.asarray(shade(coat(1e5), optics(), t, n, l, v, light, skin))
    np.testing.assert_allclose(buried, shade(coat(1e5), optics(), t, n, l, v, light, 0.0 * skin), rtol=closed)
    tinted = fakefur.fur_directional_attenuation(np.linspace(-1, 1, 9), np.full(9, 0.7), np.full(9, 0.7))
    np.testing.assert_allclose(tinted, 0.7, rtol=closed)


def test_average_of_a_footprint() -> None:
    mean = np.array([[0.0, 0.0, 1.0], [0.3, 0.0, 0.4], [0.0, 0.0, 0.0], [1e-6, 0.0, 0.0], [0.0, 2.0, 0.0]])
    average = fakefur.fur_average(mean)
    np.testing.assert_allclose(average["variance"], [0.0, 1.0, 999.0, 999.0, 0.0], rtol=tolerance("rounded"))
    expected = np.array([[0, 0, 1], [0.6, 0, 0.8], [0, 0, 1], [1, 0, 0], [0, 1, 0]])
    np.testing.assert_allclose(average["tangent"], expected, rtol=tolerance("rounded"))
