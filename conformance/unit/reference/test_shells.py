"""The references of shells and fins: exact ends, counts of layers, and the lecture's misprints."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from conformance.reference import shells
from conformance.unit.support.tolerances import tolerance

CHECKS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("figures.toml").read_text(encoding="utf-8"))[
    "shells"
]
SEED = 2001


def directions(count: int, seed: int = SEED) -> Any:
    """Uniform directions (count, 3)."""
    x = np.random.Generator(np.random.Philox(seed)).normal(size=(count, 3))
    return x / np.linalg.norm(x, axis=1, keepdims=True)


def test_heights_end_at_zero_and_one() -> None:
    for layers in (1, 2, 3, 16, 41, 47, 256):
        index = np.arange(layers, dtype=np.uint32)
        height = shells.shell_height(index, np.full(layers, layers, dtype=np.uint32))
        assert height[0] == 0.0
        assert height[-1] == (1.0 if layers > 1 else 0.0)
        assert (np.diff(height) > 0.0).all()
    beyond = shells.shell_height(np.array([9, 2**32 - 1], np.uint32), np.array([4, 4], np.uint32))
    np.testing.assert_array_equal(beyond, [1.0, 1.0])


def test_shadow_is_exact_at_both_ends() -> None:
    lowest = np.random.Generator(np.random.Philox(SEED)).random(1000)
    np.testing.assert_array_equal(shells.shell_shadow(np.zeros(1000), lowest), lowest)
    np.testing.assert_allclose(shells.shell_shadow(np.ones(1000), lowest), 1.0, rtol=tolerance("next_to_one"))
    check = CHECKS["height_by_count"]
    darkened = 1.0 - shells.shell_shadow(np.array([15.0 / 16.0]), np.array([0.3]))[0]
    assert abs(darkened - check["error"]) <= check["tolerance"]


def test_resampled_layers_count_without_the_base() -> None:
    check = CHECKS["counts"]
    for authored, drawn, alpha, right, wrong in check["rows"]:
        blended = shells.shell_alpha_resample(
            np.array([alpha]), np.array([authored - 1.0]), np.array([drawn - 1.0])
        )
        every = shells.shell_alpha_resample(
            np.array([alpha]), np.array([1.0 * authored]), np.array([1.0 * drawn])
        )
        assert abs((1.0 - blended[0]) ** (drawn - 1) - right) <= check["tolerance"]
        assert abs((1.0 - every[0]) ** (drawn - 1) - wrong) <= check["tolerance"]
        assert abs((1.0 - alpha) ** (authored - 1) - right) <= check["tolerance"]


def test_opaque_and_clear_layers_stay_so() -> None:
    drawn = np.array([0.0, 1.0, 8.0, 1e4])
    np.testing.assert_array_equal(
        shells.shell_alpha_resample(np.ones(4), np.full(4, 16.0), drawn), np.ones(4)
    )
    np.testing.assert_array_equal(
        shells.shell_alpha_resample(np.zeros(4), np.full(4, 16.0), drawn), np.zeros(4)
    )
    slant = np.array([-1.0, 0.0, 1e-30, 0.3])
    np.testing.assert_array_equal(shells.shell_alpha_view(np.zeros(4), slant), np.zeros(4))
    np.testing.assert_array_equal(shells.shell_alpha_view(np.ones(4), slant), np.ones(4))
    np.testing.assert_allclose(shells.shell_alpha_view(np.array([0.25]), np.array([-0.5])), 1.0 - 0.75**2)


def test_printed_shade_errs_as_documented() -> None:
    check = CHECKS["printed_shade"]
    angle = np.linspace(0.0, np.pi / 2.0, 4001)
    count = len(angle)
    n, l = np.tile([0.0, 0.0, 1.0], (count, 1)), np.stack([np.sin(angle), 0.0 * angle, np.cos(angle)], axis=1)
    white, black = np.ones((count, 3)), np.zeros((count, 3))
    for exponent, expected in zip(check["exponents"], check["errors"], strict=True):
        arguments = (n, l, l, white, np.full(count, exponent), black, np.ones(count))
        error = np.max(np.abs(shells.shell_shade(*arguments) - shells.shell_shade_printed(*arguments)))
        assert abs(error - expected) <= check["tolerance"], exponent


def test_fin_opacities_have_the_documented_means() -> None:
    check = CHECKS["fins"]
    count = 400000
    random = np.random.Generator(np.random.Philox(SEED))
    n, n_fin = np.tile([0.0, 0.0, 1.0], (count, 1)), np.tile([1.0, 0.0, 0.0], (count, 1))
    azimuth = random.uniform(0.0, 2.0 * np.pi, count)
    polar = random.uniform(0.0, np.pi / 2.0, count)
    ring = np.sin(polar)
    tilted = np.stack([ring * np.cos(azimuth), ring * np.sin(azimuth), np.cos(polar)], axis=1)
    for name, v in (("polar", tilted), ("sphere", directions(count))):
        fin, surface = shells.fin_opacity(v, n_fin), shells.fin_opacity_surface(v, n)
        assert abs(fin.mean() - check[name][0]) <= check["tolerance"], (name, fin.mean())
        assert abs(surface.mean() - check[name][1]) <= check["tolerance"], (name, surface.mean())
        assert (fin <= surface + tolerance("rounded")).all()


def test_fins_at_the_silhouette() -> None:
    a = np.array([0.0, 0.0, 0.5, -0.5, 1e-30, 0.3, 1.0, -1.0])
    b = np.array([0.0, 0.7, -0.5, -0.5, 1e-30, 0.1, 1.0, -1.0])
    opacity = shells.fin_opacity_silhouette(a, b, np.full(8, 0.25))
    np.testing.assert_allclose(opacity, [1.0, 1.0, 1.0, 0.0, 1.0, 0.6, 0.0, 0.0], atol=tolerance("rounded"))
    sharp = shells.fin_opacity_silhouette(np.array([1e-7, 1e-5]), np.array([1e-7, 1e-5]), np.zeros(2))
    np.testing.assert_allclose(sharp, [0.9, 0.0])


def test_fin_frames() -> None:
    n, edge = directions(1000), directions(1000, SEED + 1) * 37.0
    normal = shells.fin_normal(edge, n)
    for other in (n, edge):
        np.testing.assert_allclose(np.sum(normal * other, axis=1), 0.0, atol=tolerance("long_vectors"))
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, rtol=tolerance("unit_length"))
    along = shells.fin_normal(3.0 * n, n)
    np.testing.assert_allclose(np.linalg.norm(along, axis=1), 1.0, rtol=tolerance("unit_length"))
    up = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    np.testing.assert_allclose(
        shells.fin_normal(0.0 * up, up), [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], atol=tolerance("rounded")
    )
    tip = shells.fin_position(edge, n, np.ones(1000), np.full(1000, 2.0))
    np.testing.assert_allclose(np.linalg.norm(tip - edge, axis=1), 2.0, rtol=tolerance("long_vectors"))


def test_shells_are_never_longer_than_the_coat() -> None:
    random = np.random.Generator(np.random.Philox(SEED))
    n, height = directions(1000), random.random(1000)
    comb, force = random.normal(size=(2, 1000, 3))
    moved = shells.shell_offset(0.0 * n, n, np.full(1000, 3.0), height, comb, force)
    np.testing.assert_allclose(np.linalg.norm(moved, axis=1), 3.0 * height, rtol=tolerance("long_vectors"))
    cancelled = shells.shell_offset(0.0 * n, n, np.ones(1000), np.ones(1000), -n, 0.0 * n)
    np.testing.assert_allclose(np.linalg.norm(cancelled, axis=1), 1.0, rtol=tolerance("long_vectors"))


def test_blending() -> None:
    under, over = np.array([[0.2, 0.4, 0.6]] * 3), np.array([[1.0, 0.5, 0.0]] * 3)
    got = shells.blend_over(under, over, np.array([0.0, 0.5, 1.0]))
    np.testing.assert_allclose(got, [under[0], [0.6, 0.45, 0.3], over[0]], rtol=tolerance("rounded"))
