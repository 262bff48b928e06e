"""Estimators of light from environment maps: exactness on simple skies, rates, and published figures."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from codegen.maps import latlong, prefilter
from conformance.light import estimators, published
from conformance.light.environment import Environment, MapSampler, NearestTexel
from conformance.light.lobes import Lobe, PowerLobe, View, about
from conformance.light.published import FIGURES, Kind, environment, sampler, truth, views
from conformance.reference.lobes import LOBES
from conformance.reference.sampling import sphere_uniform

SETTINGS = {"exponent": 20.0, "exponent_x": 10.0, "exponent_y": 100.0, "alpha_x": 0.2, "alpha_y": 0.4}
SETTINGS |= {"spread": 0.9, "specular": 0.5}
VIEW = np.array([0.3, -0.4, np.sqrt(0.75)])
ROUNDING = 1e-9
"""Float64 sums of at most a few thousand terms of order 1."""


def lobe(name: str) -> Lobe:
    return Lobe(name, tuple(SETTINGS[parameter] for parameter in LOBES[name]))


@cache
def sky(height: int = 64) -> Environment:
    """A smooth sky without negative values."""
    w = latlong.directions(height, 2 * height)
    return Environment(
        np.stack([1.0 + 0.5 * w[..., 1], 1.2 + 0.3 * w[..., 0], 1.5 - 0.4 * w[..., 2]], axis=-1)
    )


def around(count: int) -> View:
    normals = np.asarray(sphere_uniform(estimators.sequence(count)))
    return about(normals, np.broadcast_to(VIEW, normals.shape))


# --------------------------------------------------------------------------------------- simple skies


@pytest.mark.parametrize("name", sorted(LOBES))
def test_every_estimator_of_every_lobe_agrees_with_quadrature_on_a_smooth_sky(name: str) -> None:
    here, view, chosen, u = sky(32), around(3), lobe(name), estimators.sequence(2048)
    right = estimators.quadrature(here, view, chosen)
    found = {
        "plain": estimators.plain(here, view, chosen, u),
        "filtered": estimators.filtered(here, view, chosen, u),
        "guarded": estimators.guarded(here, view, chosen, u),
        "combined": estimators.combined(here, view, chosen, *estimators.halves(2048), MapSampler(here)),
        "grid": estimators.grid(here, view, chosen, 32),
    }
    # 2048 points of a sequence whose discrepancy falls like log(n) / n, and the map's own resampling.
    errs = {which: estimators.rms(estimate, right) for which, estimate in found.items()}
    assert max(errs.values()) <= FIGURES["smooth_sky"], errs


@pytest.mark.parametrize("count", [1, 7, 40])
def test_a_constant_sky_is_found_by_one_sample_of_a_lobe_that_is_its_own_density(count: int) -> None:
    here, view = Environment(np.full((32, 64, 3), 2.5)), around(5)
    for estimate in (estimators.plain, estimators.filtered, estimators.guarded):
        found = estimate(here, view, PowerLobe(parameters=(30.0,)), estimators.sequence(count))
        assert np.abs(found - 2.5).max() <= ROUNDING


@pytest.mark.parametrize("name", sorted(LOBES))
@pytest.mark.parametrize("pixels", [np.zeros((4, 8, 3)), np.full((1, 1, 3), 2.0), np.full((3, 5, 3), 1e5)])
def test_black_tiny_and_bright_maps_stay_finite(name: str, pixels: np.ndarray) -> None:
    here, view, chosen = Environment(pixels, size=8), around(3), lobe(name)
    for count in (1, 3):
        u = estimators.sequence(count)
        for found in (
            estimators.plain(here, view, chosen, u),
            estimators.filtered(here, view, chosen, u),
            estimators.combined(here, view, chosen, *estimators.halves(count), MapSampler(here)),
        ):
            assert np.isfinite(found).all() and (found >= 0.0).all()
            assert pixels.any() or not found.any()


def test_the_map_sampler_draws_what_its_density_says() -> None:
    here = sky()
    chosen = MapSampler(here)
    w = chosen.sample(estimators.sequence(4096))
    assert np.abs(np.linalg.norm(w, axis=1) - 1.0).max() <= ROUNDING
    # The mean of 1 / pdf over its own samples is the solid angle of all that has light, here the sphere.
    assert abs((1.0 / chosen.pdf(w)).mean() / (4.0 * np.pi) - 1.0) <= FIGURES["smooth_sky"]
    # And the mean of radiance / pdf is the energy of the map.
    found = (here.radiance(w) / chosen.pdf(w)[:, None]).mean(axis=0)
    assert np.abs(found / here.energy.sum(axis=0) - 1.0).max() <= FIGURES["smooth_sky"]


def test_plain_estimates_converge_at_the_rate_of_random_samples_and_filtering_leaves_a_bias() -> None:
    here, view, chosen = environment("dawn"), around(6), lobe("phong")
    right = estimators.quadrature(here, view, chosen)
    generator = np.random.default_rng(11)
    allowed = FIGURES["rate"]
    counts = allowed["samples"]

    def error(estimate: estimators.Estimator, count: int) -> float:
        runs = [
            estimators.rms(estimate(here, view, chosen, generator.random((count, 2))), right)
            for _ in range(allowed["runs"])
        ]
        return float(np.sqrt(np.mean(np.square(runs))))

    slope = np.polyfit(np.log(counts), np.log([error(estimators.plain, n) for n in counts]), 1)[0]
    assert abs(slope - allowed["slope"]) <= allowed["scatter"]
    bias = estimators.filtered(here, view, chosen, estimators.sequence(40)) - right
    scatter = estimators.filtered(here, view, chosen, estimators.sequence(2048)) - right
    assert np.abs(bias).mean() > np.abs(scatter).mean()


# ------------------------------------------------------------------------------------ published figures


def near(found: float, expected: float) -> bool:
    allowed = FIGURES["tolerance"]
    return bool(abs(found - expected) <= allowed["absolute"] + allowed["relative"] * expected)


DEFAULT = {"power": {("dawn", "10"), ("studio", "100")}, "strand": {("studio", "100")}}
"""The maps and exponents of a normal run; the others take minutes of quadrature and run nightly."""


def errors(kind: Kind, name: str, exponent: float, *estimates: estimators.Estimator) -> list[float]:
    return [published.error(name, kind, exponent, estimate) for estimate in estimates]


def rows(kind: Kind) -> list[Any]:
    """One case per map and exponent."""
    return [
        pytest.param(
            row,
            exponent,
            marks=[] if (row["map"], exponent) in DEFAULT[kind] else [pytest.mark.nightly],
            id=f"{row['map']}-{exponent}",
        )
        for row in FIGURES[kind]
        for exponent in row["filtered"]
    ]


@pytest.mark.parametrize("kind", ["power", "strand"])
def test_every_published_map_and_exponent_has_a_case(kind: Kind) -> None:
    assert {(case.values[0]["map"], case.values[1]) for case in rows(kind)} >= DEFAULT[kind]


@pytest.mark.parametrize(("row", "exponent"), rows("power"))
def test_power_lobes_err_as_published(row: dict[str, Any], exponent: str) -> None:
    found = errors("power", row["map"], float(exponent), estimators.filtered, estimators.plain)
    assert near(found[0], row["filtered"][exponent]) and near(found[1], row["plain"][exponent]), found


@pytest.mark.parametrize(("row", "exponent"), rows("strand"))
def test_strand_lobes_err_as_published(row: dict[str, Any], exponent: str) -> None:
    found = errors("strand", row["map"], float(exponent), estimators.filtered, estimators.plain)
    assert near(found[0], row["filtered"][exponent]) and near(found[1], row["plain"][exponent]), found


@pytest.mark.parametrize("row", FIGURES["grid"][:1], ids=lambda row: row["map"])
def test_grids_need_their_solid_angles(row: dict[str, Any]) -> None:
    grids_err_as_published(row)


@pytest.mark.nightly
@pytest.mark.parametrize("row", FIGURES["grid"][1:], ids=lambda row: row["map"])
def test_grids_on_other_maps(row: dict[str, Any]) -> None:
    grids_err_as_published(row)


def grids_err_as_published(row: dict[str, Any]) -> None:
    here, exponent = environment(row["map"]), float(row["exponent"])
    view, chosen = views("power"), published.lobe("power", exponent)
    right = truth(row["map"], "power", exponent)
    for count, expected in row["weighted"].items():
        assert near(estimators.rms(estimators.grid(here, view, chosen, int(count)), right), expected)
    for count, expected in row["alike"].items():
        found = estimators.grid(here, view, chosen, int(count), weighted=False)
        assert near(estimators.rms(found, right), expected)


QUICKLY_PREFILTERED = ("16", "32")
"""Sizes of a normal run, of the first map; each doubling takes four times as long."""


@pytest.mark.parametrize(
    ("row", "size"),
    [
        pytest.param(
            row,
            size,
            id=f"{row['map']}-{size}",
            marks=()
            if row is FIGURES["prefiltered"][0] and size in QUICKLY_PREFILTERED
            else pytest.mark.nightly,
        )
        for row in FIGURES["prefiltered"]
        for size in row["size"]
    ],
)
def test_prefiltered_maps_err_as_published(row: dict[str, Any], size: str) -> None:
    discs = prefilter.prefilter(environment(row["map"]).pixels, row["exponent"], size=int(size))
    lookup = Environment(np.zeros((2, 4, 3)), size=int(size))
    lookup.levels[0] = discs
    right = truth(row["map"], "power", float(row["exponent"]))
    assert near(estimators.rms(lookup.radiance(views("power").normal), right), row["size"][size])


RANDOM_DEFAULT = {("dawn", "10")}


@pytest.mark.parametrize(
    ("row", "exponent"),
    [
        pytest.param(
            row,
            exponent,
            marks=[] if (row["map"], exponent) in RANDOM_DEFAULT else [pytest.mark.nightly],
            id=f"{row['map']}-{exponent}",
        )
        for row in FIGURES["random"]["rows"]
        for exponent in row["lobe"]
    ],
)
def test_random_samples_of_lobe_and_map_err_as_published(row: dict[str, Any], exponent: str) -> None:
    found = of_random_samples(row["map"], float(exponent))
    for way, batches in found.items():
        margin = 1.0 + FIGURES["random"]["margin"][way]
        assert batches.min() / margin <= row[way][exponent] <= batches.max() * margin, found


def test_lobe_and_map_together_gain_where_neither_is_much_better_alone() -> None:
    found = of_random_samples("dawn", 10.0)
    error = {way: float(np.sqrt(np.mean(batches**2))) for way, batches in found.items()}
    assert max(error["balance"], error["power"]) < min(error["lobe"], error["map_alone"]), error


@cache
def of_random_samples(name: str, exponent: float) -> dict[str, np.ndarray]:
    """Errors of batches of runs with 40 random samples, by how these are divided between lobe and map."""
    here = NearestTexel(environment(name).pixels, size=1)
    view = views("power", every=4)
    right = prefilter.convolved(here.pixels, exponent, view.normal)
    ways = {
        "lobe": (40, 0, False),
        "map_alone": (0, 40, False),
        "balance": (20, 20, False),
        "power": (20, 20, True),
    }
    allowed, generator = FIGURES["random"], np.random.default_rng(23)
    squares: dict[str, list[float]] = {way: [] for way in ways}
    for _ in range(allowed["batches"] * allowed["runs"]):
        for way, (ours, theirs, power) in ways.items():
            points = generator.random((ours, 2)), generator.random((theirs, 2))
            estimate = estimators.combined(
                here, view, published.lobe("power", exponent), *points, sampler(name), power=power
            )
            squares[way].append(estimators.rms(estimate, right) ** 2)
    return {
        way: np.sqrt(np.reshape(found, (allowed["batches"], -1)).mean(axis=1))
        for way, found in squares.items()
    }


def test_filtering_keeps_its_promises_on_dawn() -> None:
    wide = FIGURES["promised"]["filtered_dawn"]
    exponent = float(wide["plain_exponent"])
    found, without = errors("power", "dawn", exponent, estimators.filtered, estimators.plain)
    assert exponent in wide["exponents"]
    assert found <= wide["at_most"] and without >= wide["plain_at_least"] * found


@pytest.mark.nightly
def test_filtering_keeps_its_promises_on_dawn_for_sharper_lobes() -> None:
    wide, sharp = FIGURES["promised"]["filtered_dawn"], FIGURES["promised"]["guarded_dawn"]
    for exponent in wide["exponents"]:
        assert errors("power", "dawn", float(exponent), estimators.filtered)[0] <= wide["at_most"]
    assert errors("power", "dawn", float(sharp["exponent"]), estimators.guarded)[0] <= sharp["at_most"]


@pytest.mark.parametrize(
    "exponent",
    [
        pytest.param(p, marks=[] if p == 100 else [pytest.mark.nightly])
        for p in FIGURES["promised"]["combined_studio"]["exponents"]
    ],
)
def test_the_strand_lobe_on_a_peaked_map_gains_from_the_maps_own_samples(exponent: int) -> None:
    isotropic, both = errors(
        "strand", "studio", float(exponent), estimators.filtered, published.combined("studio")
    )
    assert both * FIGURES["promised"]["combined_studio"]["better_by"] <= isotropic
