"""The visibility buffer: silhouette, normals, orientation of the camera, shadows, the brush's map."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
import trimesh

from conformance.picture.brush import Brush, strand_field, strand_map
from conformance.picture.mesh import Mesh, smooth
from conformance.picture.tolerances import tolerance
from conformance.picture.visibility import Camera, Visibility, see

FRONT = Camera(eye=(0.0, 0.0, 10.0), target=(0.0, 0.0, 0.0), field_of_view=30.0)
LIGHT = (0.0, 0.0, 1.0)
BRUSH = Brush(axis=(0.0, 1.0, 0.0), amplitude=0.3)


def sphere(centre: tuple[float, float, float] = (0.0, 0.0, 0.0), radius: float = 1.0) -> Mesh:
    ball = trimesh.creation.icosphere(subdivisions=4, radius=radius)
    ball.apply_translation(centre)
    return smooth(ball)


def lengths(a: npt.NDArray[np.float32]) -> npt.NDArray[np.float64]:
    found: npt.NDArray[np.float64] = np.linalg.norm(a.astype(np.float64), axis=1)
    return found


@pytest.fixture(scope="module")
def ball() -> Visibility:
    return see(sphere(), FRONT, (101, 101), BRUSH, [LIGHT])


def test_the_silhouette_of_a_sphere_is_a_disc_without_holes(ball: Visibility) -> None:
    rows, columns = np.nonzero(ball.mask)
    x, y = columns - 50.0, rows - 50.0
    radius = 50.5 * np.tan(np.arcsin(1.0 / 10.0)) / np.tan(np.radians(15.0))  # of the tangent cone, pixels
    assert np.hypot(x, y).max() < radius
    assert ball.mask[np.hypot(*np.mgrid[-50:51, -50:51]) < 0.98 * radius].all()


def test_vectors_are_unit_in_float32(ball: Visibility) -> None:
    for vectors in (ball.n, ball.t, ball.v, ball.map_tangent, ball.l[0]):
        assert vectors.dtype == np.float32
        assert len(vectors) == np.count_nonzero(ball.mask)
        assert np.abs(lengths(vectors) - 1.0).max() <= tolerance("unit_length")


def test_normals_of_a_sphere_face_the_eye(ball: Visibility) -> None:
    assert (np.sum(ball.n * ball.v, axis=1) > 0.0).mean() > 0.99  # but for facets at the very rim
    assert np.abs(ball.n - ball.position).max() < 0.02  # facets of an icosphere of four subdivisions


def test_points_lie_on_their_rays(ball: Visibility) -> None:
    rays = FRONT.directions(101, 101)[ball.mask.ravel()]
    offset = np.cross(ball.position - np.asarray(FRONT.eye), rays)
    assert np.abs(offset).max() < tolerance("position")


def test_the_camera_is_upright_and_not_mirrored() -> None:
    """A sphere up and to the right of the target is seen in the upper right quarter."""
    seen = see(sphere((1.0, 1.5, 0.0), 0.3), FRONT, (80, 60), BRUSH, [LIGHT])
    rows, columns = np.nonzero(seen.mask)
    assert rows.max() < 30
    assert columns.min() > 40
    assert seen.position.mean(axis=0)[:2] == pytest.approx((1.0, 1.5), abs=tolerance("mean_position"))


def test_a_sphere_stays_round_in_a_wide_picture() -> None:
    seen = see(sphere(), FRONT, (160, 80), BRUSH, [LIGHT])
    rows, columns = np.nonzero(seen.mask)
    assert np.ptp(rows) == np.ptp(columns)


def test_the_nearer_of_two_surfaces_is_seen() -> None:
    far, near = sphere((0.0, 0.0, -3.0), 2.0), sphere((0.0, 0.0, 2.0), 0.5)
    both = Mesh(
        np.concatenate([far.positions, near.positions]),
        np.concatenate([far.triangles, near.triangles + len(far.positions)]),
        np.concatenate([far.normals, near.normals]),
    )
    seen = see(both, FRONT, (61, 61), BRUSH, [(0.4, 0.0, 1.0)])
    middle = np.count_nonzero(seen.mask.ravel()[: 30 * 61 + 30])
    assert seen.position[middle, 2] == pytest.approx(2.5, abs=tolerance("facets"))
    behind = seen.position[:, 2] < 0.0
    assert 0.0 < seen.lit[0][behind].mean() < 1.0  # the far sphere lies partly in the near one's shadow


def test_shadows_can_be_left_out(ball: Visibility) -> None:
    seen = see(sphere(), FRONT, (51, 51), BRUSH, [(0.0, 0.0, -1.0)])
    assert not seen.lit[0].any()
    assert see(sphere(), FRONT, (51, 51), BRUSH, [(0.0, 0.0, -1.0)], shadows=False).lit[0].all()


def test_nothing_seen_is_an_empty_buffer() -> None:
    seen = see(sphere((50.0, 0.0, 0.0)), FRONT, (16, 16), BRUSH, [LIGHT])
    assert not seen.mask.any()
    assert seen.n.shape == (0, 3)


def test_strands_lie_in_the_surface_and_orthogonal_to_the_axis(ball: Visibility) -> None:
    field = strand_field((0.0, 1.0, 0.0), ball.n.astype(np.float64))
    assert np.abs(np.sum(field * ball.n, axis=1)).max() < tolerance("unit_length")
    assert np.abs(field[:, 1]).max() < tolerance("unit_length")


def test_the_map_stays_within_its_amplitude(ball: Visibility) -> None:
    texel = strand_map(BRUSH, ball.position)
    angle = np.abs(np.arctan2(texel[:, 1], texel[:, 0]))
    assert 0.3 * BRUSH.amplitude < angle.max() <= BRUSH.amplitude
    assert not texel[:, 2].any()
    np.testing.assert_array_equal(texel, strand_map(BRUSH, ball.position))


def test_the_map_changes_across_strands_faster_than_along_them() -> None:
    brush = Brush(axis=(0.0, 1.0, 0.0), amplitude=0.3, frequency=10.0, length=40.0)
    start = np.random.default_rng(1).uniform(-5.0, 5.0, (500, 3))
    change = [
        np.abs(strand_map(brush, start + 0.05 * np.eye(3)[k]) - strand_map(brush, start))[:, 1].mean()
        for k in range(3)
    ]
    assert change[1] > 5.0 * max(change[0], change[2])
