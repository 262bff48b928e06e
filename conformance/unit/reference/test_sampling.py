"""The sequence references against unbounded integers and published words; the samplers by their Jacobians."""

import tomllib
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath
import numpy as np

from conformance.reference import sampling
from conformance.statistics.sphere_maps import solid_angle_per_area
from conformance.unit.support.tolerances import tolerance

CHECKS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("figures.toml").read_text(encoding="utf-8"))[
    "sampling"
]
SEED = 1997


def words(*values: int) -> Any:
    """Unsigned 32-bit words."""
    return np.array(values, dtype=np.uint32)


def test_published_words() -> None:
    check = CHECKS["words"]
    for given, expected in check["pcg_hash"]:
        assert sampling.pcg_hash(words(given))[0] == expected
    for triple, hashed in check["pcg3d"]:
        np.testing.assert_array_equal(sampling.pcg3d(np.array([triple], np.uint32))[0], hashed)
    for index, first, second in check["r2"]:
        expected = [(first >> 8) * 2.0**-24, (second >> 8) * 2.0**-24]
        np.testing.assert_array_equal(sampling.r2_sequence(words(index))[0], expected)


def test_r2_constants_are_the_nearest_odd_integers() -> None:
    with mpmath.workdps(40):
        plastic = mpmath.findroot(lambda x: x**3 - x - 1, 1.3)
        for power, constant in ((1, sampling.R2_FIRST), (2, sampling.R2_SECOND)):
            assert constant % 2 == 1
            assert abs(2**32 / plastic**power - constant) < 1


def test_radical_inverse_reverses_digits() -> None:
    index = np.random.Generator(np.random.Philox(SEED)).integers(0, 1 << 32, 2000, dtype=np.uint32)
    index = np.concatenate([index, words(0, 1, 2**31, 2**32 - 1)])
    expected = [int(f"{int(i):032b}"[::-1], 2) for i in index]
    np.testing.assert_array_equal(sampling.radical_inverse_base2(index), np.array(expected, np.uint32))


def test_unit_floats_stay_below_one() -> None:
    bits = words(0, 255, 256, 2**31, 2**32 - 129, 2**32 - 1)
    values = sampling.unit_float(bits)
    assert (values < 1.0).all()
    np.testing.assert_array_equal(values, [0.0, 0.0, 2.0**-24, 0.5, 1.0 - 2.0**-24, 1.0 - 2.0**-24])


def test_hammersley_is_the_floor_of_a_fraction() -> None:
    random = np.random.Generator(np.random.Philox(SEED))
    n = random.integers(1, 2**20 + 1, 2000)
    i = (random.random(2000) * n).astype(np.int64)
    got = sampling.hammersley(i.astype(np.uint32), n.astype(np.uint32))
    expected = [
        float(Fraction(Fraction(int(a) << 24, int(b)).__floor__(), 1 << 24))
        for a, b in zip(i, n, strict=True)
    ]
    np.testing.assert_array_equal(got[:, 0], expected)
    np.testing.assert_array_equal(sampling.hammersley(words(0), words(1 << 20)), [[0.0, 0.0]])


def test_shift_wraps() -> None:
    u, shift = np.array([[0.25, 0.75], [0.5, 1.0 - 2.0**-24]]), np.array([[0.5, 0.5], [0.5, 1.0 - 2.0**-24]])
    expected = [[0.75, 0.25], [0.0, 1.0 - 2.0**-23]]
    np.testing.assert_array_equal(sampling.cranley_patterson(u, shift), expected)


def test_samplers_have_the_right_jacobian() -> None:
    check = CHECKS["jacobian"]
    u = np.random.Generator(np.random.Philox(SEED)).uniform(0.02, 0.98, (4000, 2))
    a = 2.0 * u - 1.0
    # the concentric map has a crease on both diagonals
    u = u[(np.abs(np.abs(a[:, 0]) - np.abs(a[:, 1])) > check["crease"]) & (np.abs(a).max(axis=1) > 0.05)]

    def flat(x: Any) -> Any:
        return np.concatenate([sampling.disk_concentric(x), np.zeros((len(x), 1))], axis=1)

    area = solid_angle_per_area(flat, u, check["step"])
    np.testing.assert_allclose(area, np.pi, rtol=check["tolerance"])
    solid = solid_angle_per_area(sampling.hemisphere_cosine, u, check["step"])
    height = sampling.hemisphere_cosine(u)[:, 2]
    np.testing.assert_allclose(solid * height, np.pi, rtol=check["sphere_tolerance"])
    solid = solid_angle_per_area(sampling.sphere_uniform, u, check["step"])
    np.testing.assert_allclose(solid, 4.0 * np.pi, rtol=check["sphere_tolerance"])


def test_samplers_at_the_ends_of_the_square() -> None:
    below = 1.0 - 2.0**-24
    corners = np.array([[0.0, 0.0], [0.0, below], [below, 0.0], [below, below], [0.5, 0.5]])
    for function in (sampling.hemisphere_cosine, sampling.sphere_uniform):
        np.testing.assert_allclose(np.linalg.norm(function(corners), axis=1), 1.0, rtol=tolerance("rounded"))
    np.testing.assert_array_equal(sampling.disk_concentric(corners)[-1], [0.0, 0.0])
    np.testing.assert_array_equal(sampling.hemisphere_cosine(corners)[-1], [0.0, 0.0, 1.0])
    np.testing.assert_array_equal(sampling.sphere_uniform(corners)[0], [0.0, 0.0, 1.0])
