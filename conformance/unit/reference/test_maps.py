"""The map references: inverses, numeric Jacobians, and solid angles that sum to the sphere."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conformance.reference import maps
from conformance.statistics.sphere_maps import solid_angle_per_area, texel_centres
from conformance.unit.support.tolerances import tolerance

CHECKS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("figures.toml").read_text(encoding="utf-8"))[
    "maps"
]
SPHERE = 4.0 * np.pi
SEED = 2007


def directions() -> Any:
    """Directions in general position, near and on the axes and planes, with both signs of zero."""
    random = np.random.Generator(np.random.Philox(SEED))
    general = random.normal(size=(3000, 3))
    tiny = np.concatenate([[0.0, -0.0], np.logspace(-12, -1, 12), -np.logspace(-12, -1, 12)])
    planes = random.normal(size=(len(tiny) * 30, 3))
    planes[np.arange(len(planes)), np.arange(len(planes)) % 3] = np.repeat(tiny, 30)
    signs = np.array(np.meshgrid(*[[-1.0, -0.0, 0.0, 1.0]] * 3)).reshape(3, -1).T
    x = np.concatenate([general, planes, signs[np.any(signs != 0.0, axis=1)]])
    return x / np.linalg.norm(x, axis=1, keepdims=True)


def same(got: Any, expected: Any) -> None:
    """Directions agree to the tolerance, in radians."""
    assert np.max(np.linalg.norm(got - expected, axis=1)) <= CHECKS["round_trip"]["tolerance"]


def test_round_trips() -> None:
    w = directions()
    same(maps.octahedral_decode(maps.octahedral_encode(w)), w)
    same(maps.latlong_direction(maps.latlong_uv(w)), w)
    for border in (1.0, 1.2):
        scale = np.full(len(w), border)
        looked_up = maps.dual_paraboloid_uv(w, scale)
        same(maps.dual_paraboloid_direction(looked_up["uv"], looked_up["back"], scale), w)
    front = w[w[:, 2] >= 0.0]
    same(maps.parabolic_direction(maps.parabolic_uv(front)), front)


def test_texture_coordinates_stay_in_the_square() -> None:
    w = directions()
    ones = np.ones(len(w))
    for uv in (maps.octahedral_encode(w), maps.latlong_uv(w), maps.dual_paraboloid_uv(w, ones)["uv"]):
        assert (uv >= 0.0).all()
        assert (uv <= 1.0).all()


def test_poles_and_seam_ignore_the_sign_of_zero() -> None:
    zero = np.array([[0.0, 1.0, 0.0], [-0.0, 1.0, -0.0], [0.0, -1.0, -0.0]])
    np.testing.assert_array_equal(maps.latlong_uv(zero), [[0.5, 0.0], [0.5, 0.0], [0.5, 1.0]])
    seam = np.array([[0.0, 0.0, 1.0], [-0.0, 0.0, 1.0], [0.0, -0.0, -1.0], [-0.0, 0.0, -1.0]])
    np.testing.assert_array_equal(maps.latlong_uv(seam), [[1.0, 0.5], [1.0, 0.5], [0.5, 0.5], [0.5, 0.5]])
    down = np.array([[0.0, 0.6, -0.8], [-0.0, 0.6, -0.8], [0.0, 0.0, -1.0], [-0.0, -0.0, -1.0]])
    same(maps.octahedral_decode(maps.octahedral_encode(down)), down)
    np.testing.assert_array_equal(maps.octahedral_encode(down)[0], maps.octahedral_encode(down)[1])


def interior(count: int = 2000) -> Any:
    """Texture coordinates away from the creases of all maps."""
    uv = np.random.Generator(np.random.Philox(SEED)).uniform(0.03, 0.97, (count, 2))
    p = np.abs(2.0 * uv - 1.0)
    return uv[(np.abs(p.sum(axis=1) - 1.0) > 0.02) & (p.min(axis=1) > 0.02)]


def test_solid_angles_are_the_jacobians() -> None:
    check = CHECKS["jacobian"]
    uv, size = interior(), 64.0
    many = np.full(len(uv), size)
    step, allowed = check["step"], check["tolerance"]

    def agree(per_area: Any, texel: Any) -> None:
        np.testing.assert_allclose(texel * size * size, per_area, rtol=allowed)

    agree(solid_angle_per_area(maps.octahedral_decode, uv, step), maps.octahedral_solid_angle(uv, many))
    texel = maps.latlong_solid_angle(uv[:, 1], np.full(len(uv), 1e4), np.full(len(uv), 1e4)) * 1e8
    np.testing.assert_allclose(texel, solid_angle_per_area(maps.latlong_direction, uv, step), rtol=allowed)

    def cube_face(x: Any) -> Any:
        p = np.concatenate([2.0 * x - 1.0, np.ones((len(x), 1))], axis=1)
        return p / np.linalg.norm(p, axis=1, keepdims=True)

    agree(solid_angle_per_area(cube_face, uv, step), maps.cube_solid_angle(uv, many))
    border = np.full(len(uv), 1.2)
    front = maps.dual_paraboloid_direction(uv, np.zeros(len(uv)), border)
    inside = front[:, 2] >= 0.0

    def paraboloid(x: Any) -> Any:
        return maps.dual_paraboloid_direction(x, np.zeros(len(x)), np.full(len(x), 1.2))

    measured = solid_angle_per_area(paraboloid, uv, step)
    predicted = maps.dual_paraboloid_solid_angle(front[:, 2], many, many, border) * size * size
    np.testing.assert_allclose(predicted[inside], measured[inside], rtol=allowed)


def test_solid_angles_sum_to_the_sphere() -> None:
    check = CHECKS["sums"]
    size, allowed = check["octahedral"]
    total = maps.octahedral_solid_angle(texel_centres(size, size), np.full(size * size, float(size))).sum()
    assert abs(total / SPHERE - 1.0) <= allowed
    size, allowed = check["latlong"]
    v, width, height = texel_centres(2 * size, size)[:, 1], np.full(2 * size * size, 2.0 * size), 1.0 * size
    total = maps.latlong_solid_angle(v, width, np.full(len(v), height)).sum()
    assert abs(total / SPHERE - 1.0) <= allowed
    midpoint = (2.0 * np.pi**2 * np.sin(np.pi * v) / (2.0 * size * size)).sum()
    assert abs(midpoint / SPHERE - 1.0 - check["latlong_midpoint"][1]) <= check["latlong_midpoint"][2]
    cube = 6.0 * maps.cube_solid_angle(texel_centres(256, 256), np.full(256 * 256, 256.0)).sum()
    assert abs(cube / SPHERE - 1.0) <= check["fine_digits"]


def paraboloid_sum(size: int, border: float, disc: bool) -> float:
    """Share of the sphere that the texels of a dual-paraboloid map sum to, all or those in the unit disc."""
    uv = texel_centres(size, size)
    full = np.ones(len(uv))
    z = maps.dual_paraboloid_direction(uv, 0.0 * full, border * full)[:, 2]
    counted = z >= 0.0 if disc else np.full(len(uv), True)
    angle = maps.dual_paraboloid_solid_angle(z, size * full, size * full, border * full)
    return float(2.0 * angle[counted].sum() / SPHERE)


def test_paraboloid_sums() -> None:
    check = CHECKS["sums"]
    for size, expected in check["paraboloid_in_disc"]:
        assert abs(paraboloid_sum(size, 1.0, True) - expected) <= check["fine_digits"], size
    border, size, every, disc = check["paraboloid_border"]
    assert abs(paraboloid_sum(size, border, False) - every) <= check["digits"]
    assert abs(paraboloid_sum(size, border, True) - disc) <= check["fine_digits"]
    radius, expected = check["border_texel"]
    z = (1.0 - radius**2) / (1.0 + radius**2)
    assert abs((1.0 + z) ** 2 / (1.0 + abs(z)) ** 2 - expected) <= check["digits"]


def test_level_of_detail() -> None:
    pdf = np.array([0.0, 1e-30, 1.0, 4.0, 1e30])
    level = maps.lod_from_pdf(
        pdf, np.full(5, 16.0), np.full(5, 1.0 / 1024.0), np.array([0.0, 0.0, 0.0, 0.0, 1.5])
    )
    assert level[0] <= CHECKS["lod"]["largest"]
    np.testing.assert_allclose(level[2:], [3.0, 2.0, 0.0])
    shifted = maps.lod_from_pdf(np.array([4.0]), np.array([16.0]), np.array([1.0 / 1024.0]), np.array([-3.0]))
    np.testing.assert_array_equal(shifted, [0.0])


@pytest.mark.parametrize(("heuristic", "power"), [(maps.mis_balance, 1), (maps.mis_power, 2)])
def test_heuristics_share_the_weight(heuristic: Any, power: int) -> None:
    a, b = np.array([1.0, 2.0, 0.0, 0.0, 1e30, 1e-38]), np.array([1.0, 1.0, 3.0, 0.0, 1e30, 1e-38])
    ones = np.ones(6)
    first, second = heuristic(ones, a, ones, b), heuristic(ones, b, ones, a)
    np.testing.assert_allclose((first + second)[[0, 1, 2, 4, 5]], 1.0, rtol=tolerance("rounded"))
    np.testing.assert_allclose(first, [0.5, 2.0**power / (2.0**power + 1.0), 0.0, 0.0, 0.5, 0.5])
