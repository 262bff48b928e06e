"""The lobe references: golden values, the verified table, exact arcs, and mpmath at the peak."""

import tomllib
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from conformance.reference import lobes_fibre
from conformance.reference.lobes import LOBES, REFERENCES
from conformance.statistics.charts import chart_for
from conformance.statistics.chi_square import chi_square, sidak_level
from conformance.statistics.evaluator import LobeEvaluator, grid_pairs, lobe_evaluator, reference_call, view
from conformance.statistics.furnace import albedo_by_quadrature, albedo_by_samples, reciprocity_defect
from conformance.statistics.quadrature import sphere_integral

CHECKS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("figures.toml").read_text(encoding="utf-8"))[
    "lobes"
]
TABLE = CHECKS["table"]
SEED = 2010
NOT_ITS_OWN = 1e-9
"""Distance, in radii, beyond which a ray meets another arc and not the one that it leaves."""
NEAR_AN_END = 1e-6
"""Radians from an arc's end within which rounding decides what a ray meets."""


def lobe(name: str, parameters: list[float]) -> LobeEvaluator:
    """The reference of a lobe with given parameters."""
    named = dict(zip(LOBES[name], parameters, strict=True))
    return lobe_evaluator(reference_call(REFERENCES), name, named)


def label(row: list[Any]) -> str:
    """Readable name of a row."""
    return f"{row[0]}({', '.join(f'{x:g}' for x in row[1])})"


@pytest.mark.parametrize("row", CHECKS["golden"]["rows"], ids=label)
def test_golden_values(row: list[Any]) -> None:
    name, parameters, value, pdf, sample, pdf_at_sample = row
    check, evaluator = CHECKS["golden"], lobe(name, parameters)
    l, v, u = (np.array([check[key]]) for key in "lvu")
    l, v = l / np.linalg.norm(l), v / np.linalg.norm(v)
    drawn = evaluator.sample(u, v)
    np.testing.assert_allclose(evaluator.value(l, v), value, rtol=check["tolerance"])
    np.testing.assert_allclose(evaluator.pdf(l, v), pdf, rtol=check["tolerance"])
    np.testing.assert_allclose(drawn[0], sample, atol=check["tolerance"])
    np.testing.assert_allclose(evaluator.pdf(drawn, v), pdf_at_sample, rtol=check["tolerance"])


@pytest.mark.parametrize("row", TABLE["rows"], ids=label)
def test_table_of_verified_figures(row: list[Any]) -> None:
    name, parameters, albedos, largest_weight, below = row
    evaluator = lobe(name, parameters)
    largest = share_below = 0.0
    for (polar, azimuth), expected in zip(TABLE["views"], albedos, strict=True):
        v = view(polar, azimuth)
        chart = chart_for(name, dict(evaluator.parameters), v)
        total = sphere_integral(evaluator.density(v), chart)
        assert abs(total - 1.0) <= TABLE["integral"], (polar, azimuth, total)
        albedo = albedo_by_quadrature(evaluator, v, chart, cells=20)
        assert abs(albedo - expected) <= TABLE["albedo"], (polar, azimuth, albedo)
        sampled = albedo_by_samples(evaluator, v, SEED, count=2048, sets=4)
        assert abs(sampled.mean - albedo) <= TABLE["sampled_albedo"] * max(1.0, largest_weight), (
            polar,
            azimuth,
        )
        largest, share_below = max(largest, sampled.largest), max(share_below, sampled.below)
    if largest_weight:
        assert abs(largest / largest_weight - 1.0) <= TABLE["weight"], largest
    assert abs(share_below - below) <= TABLE["below"]
    assert reciprocity_defect(evaluator, SEED, 2000) <= TABLE["reciprocity"]


@pytest.mark.parametrize("row", CHECKS["ward_albedo"]["rows"], ids=str)
def test_albedo_of_bounded_ward(row: list[Any]) -> None:
    check, evaluator = CHECKS["ward_albedo"], lobe("ward", row[:2])
    for polar, expected in zip(check["polar"], row[2], strict=True):
        v = view(polar, check["azimuth"])
        chart = chart_for("ward", dict(evaluator.parameters), v)
        assert abs(albedo_by_quadrature(evaluator, v, chart, cells=48) - expected) <= check["tolerance"], (
            polar
        )


def test_strand_density_is_tight() -> None:
    check = CHECKS["strand_ratio"]
    for exponent, largest, variance in zip(
        check["exponents"], check["largest"], check["variance"], strict=True
    ):
        evaluator, worst, widest = lobe("strand", [exponent]), 0.0, 0.0
        for polar in np.linspace(0.0, 90.0, 25):
            v = view(polar, 0.0)
            l = evaluator.sample(grid_pairs(2048, SEED), v)
            ratio = evaluator.value(l, v) / evaluator.pdf(l, v)
            ratio /= ratio.mean()
            worst, widest = max(worst, float(ratio.max())), max(widest, float(ratio.var()))
        assert worst <= largest * (1.0 + check["tolerance"]), (exponent, worst)
        assert widest <= variance * (1.0 + 2.0 * check["tolerance"]), (exponent, widest)


def test_strand_density_at_the_peak_agrees_with_mpmath() -> None:
    check = CHECKS["peak"]
    for exponent in (0.0, 1.0, 20.0, 1e5):
        for offset in (1e-6, 1e-4, 0.05):
            theta_v, theta_l = 0.7, offset - 0.7
            v, l = (np.array([[np.sin(a), 0.0, np.cos(a)]]) for a in (theta_v, theta_l))
            got = lobe("strand", [exponent]).pdf(l, v)[0]
            with mpmath.workdps(50):
                cv, sv = mpmath.sin(mpmath.mpf(theta_v)), mpmath.cos(mpmath.mpf(theta_v))
                delta, m = mpmath.mpf(theta_l) + mpmath.mpf(theta_v), mpmath.mpf(exponent) + 1
                along = cv ** (m + 1) / m
                b = along / (sv * mpmath.sqrt(2 * mpmath.pi / (m + 0.5)) + along)
                c = mpmath.cos(delta)
                y = mpmath.sqrt(1 - c**m)
                density = m * c ** (m - 1) * abs(mpmath.sin(delta)) * (b + (1 - b) / (2 * y))
                other = max(0, mpmath.cos(-delta - mpmath.mpf(theta_v)))
                exact = density / (2 * mpmath.pi * (mpmath.cos(mpmath.mpf(theta_l)) + other))
            assert abs(got / exact - 1) <= check["tolerance"], (exponent, offset)


def blocked(xi: Any, phi: float, spread: float) -> Any:
    """Whether a ray from arc angle xi toward profile angle phi starts inside its arc or meets a neighbour."""
    pitch = 2.0 * np.sin(spread)
    y, z = np.sin(xi), np.cos(xi)
    dy, dz = np.sin(phi), np.cos(phi)
    hidden = np.cos(xi - phi) <= 0.0
    for k in [*range(-8, 0), *range(1, 9)]:
        a = y - k * pitch
        b = a * dy + z * dz
        root = b * b - (a * a + z * z - 1.0)
        for sign in (-1.0, 1.0):
            distance = -b + sign * np.sqrt(np.maximum(root, 0.0))
            height, side = z + distance * dz, a + distance * dy
            on_arc = np.abs(np.arctan2(side, height)) <= spread
            hidden |= (root > 0.0) & (distance > NOT_ITS_OWN) & on_arc
    return hidden


def test_visible_arcs_agree_with_rays() -> None:
    random = np.random.Generator(np.random.Philox(SEED))
    for spread in (np.pi / 2.0, 1.2, 0.6, 0.1):
        for phi in random.uniform(-1.55, 1.55, 40):
            xi = random.uniform(-spread, spread, 100)
            gamma, side = np.array([np.pi / 2.0 - abs(phi)]), np.array([np.copysign(1.0, phi)])
            a, b = lobes_fibre.visible_arc(gamma, side, np.array([spread]))
            clear_of_ends = (np.abs(xi - a) > NEAR_AN_END) & (np.abs(xi - b) > NEAR_AN_END)
            np.testing.assert_array_equal(
                ((xi > a) & (xi < b))[clear_of_ends], ~blocked(xi, phi, spread)[clear_of_ends]
            )


def test_satin_albedos() -> None:
    check, v = CHECKS["satin"], view(0.0, 0.0)
    for spread, expected in check["diffuse_albedo"]:
        evaluator = lobe("poulin_fournier", [spread, 0.0, 20.0])
        chart = chart_for("poulin_fournier", dict(evaluator.parameters), v)
        assert abs(albedo_by_quadrature(evaluator, v, chart, cells=30) - expected) <= check["tolerance"]
    shiny = lobe("poulin_fournier", [0.6, 1.0, 20.0])
    chart = chart_for("poulin_fournier", dict(shiny.parameters), v)
    assert (
        albedo_by_quadrature(shiny, v, chart, cells=20)
        <= check["largest_specular_albedo"] + check["tolerance"]
    )


def test_samples_follow_the_densities() -> None:
    check = CHECKS["chi_square"]
    level = sidak_level(check["level"], len(check["rows"]))
    for name, parameters, polar, azimuth in check["rows"]:
        evaluator, v = lobe(name, parameters), view(polar, azimuth)
        samples = evaluator.sample(grid_pairs(check["samples"], SEED), v)
        chart = chart_for(name, dict(evaluator.parameters), v)
        outcome = chi_square(samples, evaluator.density(v), chart)
        print(f"seed {SEED}: {evaluator.name}: p {outcome.probability:.3g}")
        assert outcome.probability >= level, evaluator.name


def test_a_wrong_density_is_found() -> None:
    check = CHECKS["power"]
    for name, sampled, tested, polar, azimuth in check["rows"]:
        v, wrong = view(polar, azimuth), lobe(name, tested)
        samples = lobe(name, sampled).sample(grid_pairs(check["samples"], SEED), v)
        chart = chart_for(name, dict(wrong.parameters), v)
        outcome = chi_square(samples, wrong.density(v), chart)
        assert outcome.probability < check["level"], wrong.name


def test_zero_is_the_peak_of_every_lobe() -> None:
    u = np.zeros((1, 2))
    for row in CHECKS["golden"]["rows"]:
        evaluator = lobe(row[0], row[1])
        v = view(30.0, 40.0)
        assert np.isfinite(evaluator.sample(u, v)).all()
        assert evaluator.pdf(evaluator.sample(u, v), v)[0] > 0.0, evaluator.name
