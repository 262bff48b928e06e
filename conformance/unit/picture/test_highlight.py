"""Where the highlight of a brushed surface lies: on the cone t.v = -t.l, and across the strands."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import trimesh

from codegen.library import load_library
from conformance.picture.backends import models, open_backend
from conformance.picture.brush import Brush
from conformance.picture.mesh import Mesh, read_mesh, smooth
from conformance.picture.scene import Light, Picture, Scene, read_scene
from conformance.picture.shade import bind, shade
from conformance.picture.tolerances import tolerance
from conformance.picture.vectors import dot, unit
from conformance.picture.visibility import Camera, Visibility, see

Doubles = npt.NDArray[np.float64]

SCENE = Path(__file__).parents[3] / "examples" / "scenes" / "brushed-bunny.toml"
SMALL = (256, 256)
LIT = 0.05  # least n.l of the samples that are looked at: the inherited shadow is divided out


def picture_of(scene: Scene) -> Picture:
    assert scene.picture is not None
    return scene.picture


@pytest.fixture(scope="module")
def scene() -> Scene:
    """The scene of the demonstration with nothing but a white highlight."""
    scene = read_scene(SCENE)
    parameters = {**scene.parameters, "k_diffuse": (0.0, 0.0, 0.0), "k_specular": (1.0, 1.0, 1.0)}
    return replace(scene, parameters=parameters)


@pytest.fixture(scope="module")
def mesh(scene: Scene) -> Mesh:
    return read_mesh(picture_of(scene).mesh, 1)


def view(scene: Scene, mesh: Mesh, brush: Brush) -> Visibility:
    picture = picture_of(scene)
    return see(mesh, picture.camera, SMALL, brush, [light.direction for light in picture.lights], False)


def highlight(scene: Scene, seen: Visibility) -> Doubles:
    """The strand cosine to its exponent (N,); 0 where the light is low."""
    library = load_library()
    light = Light(picture_of(scene).lights[0].direction, (1.0, 1.0, 1.0))
    shaded = shade(open_backend("numpy", library), bind(scene, models(library)), seen, (light,))[:, 0]
    n_dot_l = dot(seen.n.astype(np.float64), seen.l[0].astype(np.float64))
    level: Doubles = np.where(n_dot_l > LIT, shaded / np.maximum(n_dot_l, LIT), 0.0)
    return level


def strand_tangents(seen: Visibility) -> Doubles:
    """Tangents of the single strands, from the definition of a tangent map."""
    n, t, texel = (a.astype(np.float64) for a in (seen.n, seen.t, seen.map_tangent))
    n = unit(n)
    tangent = unit(t - dot(t, n)[:, None] * n)
    across = np.cross(n, tangent)
    mapped = texel[:, :1] * tangent + texel[:, 1:2] * across + texel[:, 2:] * n
    return unit(mapped - dot(mapped, n)[:, None] * n)


def test_the_brightest_samples_lie_on_the_cone(scene: Scene, mesh: Mesh) -> None:
    seen = view(scene, mesh, picture_of(scene).brush)
    level = highlight(scene, seen)
    tangent = strand_tangents(seen)
    from_cone = np.abs(dot(tangent, seen.v.astype(np.float64)) + dot(tangent, seen.l[0].astype(np.float64)))
    assert from_cone[np.argmax(level)] < tolerance("cone_peak")
    top = level > tolerance("cone_level")
    assert np.count_nonzero(top) > 500
    exponent = scene.parameters["exponent"]
    assert isinstance(exponent, float)
    widest = np.sqrt(2.0 * (1.0 - tolerance("cone_level") ** (1.0 / exponent)))
    assert from_cone[top].max() <= widest + tolerance("unit_length")


def test_the_highlight_tells_the_cone_from_its_mirror_image(scene: Scene, mesh: Mesh) -> None:
    """The lecture's printed sign would put the highlight on t.v = +t.l."""
    seen = view(scene, mesh, picture_of(scene).brush)
    top = highlight(scene, seen) > tolerance("cone_level")
    tangent = strand_tangents(seen)[top]
    along_view = dot(tangent, seen.v[top].astype(np.float64))
    along_light = dot(tangent, seen.l[0][top].astype(np.float64))
    assert np.median(np.abs(along_view - along_light)) > 3.0 * np.median(np.abs(along_view + along_light))


def test_the_highlight_changes_along_the_strands_not_across_them(scene: Scene, mesh: Mesh) -> None:
    seen = view(scene, mesh, replace(picture_of(scene).brush, amplitude=0.0))
    along, across = surface_slopes(seen, highlight(scene, seen))
    assert np.median(along) > tolerance("gradient_ratio") * np.median(across)


def surface_slopes(seen: Visibility, level: Doubles) -> tuple[Doubles, Doubles]:
    """Slopes of the level along and across the strands, from neighbouring samples on one smooth piece."""
    height, width = seen.mask.shape

    def grid(values: Doubles) -> Doubles:
        filled = np.full((height, width, *values.shape[1:]), np.nan)
        filled[seen.mask] = values
        return filled

    place, value = grid(seen.position), grid(level)
    tangent = grid(strand_tangents(seen))[:-1, :-1]
    across = np.cross(grid(seen.n.astype(np.float64))[:-1, :-1], tangent)
    right, down = place[:-1, 1:] - place[:-1, :-1], place[1:, :-1] - place[:-1, :-1]
    steps = np.stack([right, down], axis=-2) @ np.stack([tangent, across], axis=-1)
    rises = np.stack([value[:-1, 1:] - value[:-1, :-1], value[1:, :-1] - value[:-1, :-1]], axis=-1)
    middle = value[:-1, :-1]
    usable = np.isfinite(steps).all(axis=(-2, -1)) & np.isfinite(rises).all(axis=-1)
    usable &= (middle > 0.2) & (middle < tolerance("cone_level"))
    usable &= np.abs(np.linalg.det(np.where(usable[..., None, None], steps, np.eye(2)))) > tolerance(
        "edge_on"
    )
    slopes = np.abs(np.linalg.solve(steps[usable], rises[usable][..., None])[..., 0])
    return slopes[:, 0], slopes[:, 1]


@pytest.mark.parametrize(("axis", "strands_run"), [((1.0, 0.0, 0.0), 1), ((0.0, 1.0, 0.0), 0)])
def test_the_highlight_of_a_cylinder_is_a_band_across_its_strands(
    scene: Scene, axis: tuple[float, float, float], strands_run: int
) -> None:
    """A cylinder upright in the view, brushed upright (1) or around (0)."""
    upright = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=np.float64)
    cylinder = trimesh.creation.cylinder(radius=1.0, height=8.0, sections=128, transform=upright, cap=False)
    camera = Camera(eye=(0.0, 0.0, 6.0), target=(0.0, 0.0, 0.0), field_of_view=40.0)
    towards = (0.2, 0.2, 1.0)
    seen = see(smooth(cylinder), camera, (400, 400), Brush(axis), [towards], False)
    picture = replace(picture_of(scene), lights=(Light(towards, (1.0, 1.0, 1.0)),))
    sharp = replace(scene, parameters={**scene.parameters, "exponent": 500.0}, picture=picture)
    top = highlight(sharp, seen) > tolerance("cone_level")
    extent = seen.position[top].std(axis=0)
    assert extent[1 - strands_run] > tolerance("band_ratio") * extent[strands_run]
