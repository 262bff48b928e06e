"""Fur is drawn alike by OpenGL and WebGPU, and each piece of it does what it is there for.

Plan.
  agreement  both example scenes, small, on both targets; GLSL 3.30 and ES 3.00 on one driver; with
             parameters folded in
  pieces     on a ball: shells reach beyond the base, fins show at the silhouette only, the shadow darkens
             towards the skin, bald skin is the base, another seed is another coat
  camera     the target is in the middle, near and far end of the scene are the ends of the depth range
  command    `vair render` draws a scene with fur
  refused    every key of [fur], shadows, sizes, targets that draw no fur
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from codegen.cli import run
from codegen.errors import UserError
from codegen.fur.stages import DIALECTS
from codegen.library import load_library
from conformance.picture.fur.studio import FurStudio, open_fur, set_up_fur
from conformance.picture.rasterise import view_projection
from conformance.picture.scene import read_scene
from conformance.picture.tolerances import tolerance
from conformance.picture.tone import steps_apart
from conformance.picture.visibility import Camera
from conformance.unit.support.drivers import need

ROOT = Path(__file__).parents[3]
SCENES = ROOT / "examples" / "scenes"
FURRY = (SCENES / "furry-bunny.toml").read_text(encoding="utf-8")
Samples = np.ndarray[Any, np.dtype[np.float32]]


def samples(studio: FurStudio, target: str) -> Samples:
    """Premultiplied colour and coverage (height, width, 4)."""
    drawing = open_fur(studio, target)
    try:
        return drawing.draw(studio.block.pack(studio.values(target)))
    finally:
        drawing.release()


@pytest.mark.parametrize("name", ["furry-bunny", "shell-lit-bunny"])
def test_opengl_and_webgpu_draw_the_same_fur(name: str) -> None:
    need("glsl", "wgsl")
    studio = set_up_fur(load_library(), SCENES / f"{name}.toml", size=(112, 112), supersample=1, subdivide=0)
    studio = replace(studio, fur=replace(studio.fur, layers=12))
    gl, gpu = (samples(studio, target) for target in ("glsl", "wgsl"))
    assert 0.3 < (gl[..., 3] > 0.0).mean() < 0.8 and gl.max() > 0.1
    steps = steps_apart(gl[..., :3].astype(np.float64), gpu[..., :3].astype(np.float64))
    assert steps.mean() < tolerance("fur_mean_steps")
    assert (steps.max(axis=2) < tolerance("fur_pixel_steps")).mean() > tolerance("fur_pixel_share")


def test_the_dialects_of_glsl_draw_the_same_fur(ball: FurStudio) -> None:
    pictures = []
    for dialect in DIALECTS["glsl"]:
        drawing = open_fur(ball, "glsl", dialect)
        pictures.append(drawing.draw(ball.block.pack(ball.values("glsl"))))
        drawing.release()
    assert len(pictures) == 2 and pictures[0].max() > 0.1
    assert np.array_equal(pictures[0], pictures[1])


def test_fixed_parameters_draw_the_same_fur(ball: FurStudio) -> None:
    fixed = ball.fixed()
    assert fixed.shading.function.name == "fakefur_shade_fixed" and fixed.shading.material == ()
    assert fixed.block.size < ball.block.size
    general, folded = (samples(studio, "glsl")[..., :3].astype(np.float64) for studio in (ball, fixed))
    assert steps_apart(general, folded).max() < tolerance("backend_steps")
    painted = replace(ball, fur=replace(ball.fur, channels=("red", "green")))
    kept = [slot.path for slot in painted.fixed().shading.material]
    assert kept == ["coat.density", "coat.hair_length"]
    drawn = samples(painted.fixed(), "glsl")[..., :3].astype(np.float64)
    assert steps_apart(general, drawn).max() < tolerance("backend_steps")


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> FurStudio:
    """A ball of radius 3 with fur, seen from the front, on whatever target draws fur here."""
    need("glsl")
    folder = tmp_path_factory.mktemp("ball")
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=3.0)
    mesh.export(folder / "ball.ply")
    text = FURRY.replace("../data/bunny.obj", "ball.ply").replace("subdivide = 1", "subdivide = 0")
    text = text.replace("eye = [-7.0, 9.5, 24.0]", "eye = [0.0, 0.0, 12.0]")
    text = text.replace("target = [0.1, 4.75, 0.0]", "target = [0.0, 0.0, 0.0]")
    text = text.replace("field_of_view = 27.0", "field_of_view = 36.0").replace(
        "strength = 1.7", "strength = 0.2"
    )
    (folder / "ball.toml").write_text(text, encoding="utf-8")
    return set_up_fur(load_library(), folder / "ball.toml", size=(96, 96), supersample=1)


@pytest.fixture(scope="module")
def shot(ball: FurStudio) -> Callable[..., Samples]:
    """A picture of the ball with fields of its coat changed."""

    def draw(**changes: Any) -> Samples:
        return samples(replace(ball, fur=replace(ball.fur, **changes)), "glsl")

    return draw


def radius(ball: FurStudio) -> Samples:
    """How far the rays through the pixels (96, 96) pass from the ball's centre."""
    directions = ball.picture.camera.directions(96, 96)
    distance = 12.0 * np.linalg.norm(np.cross(directions, [0.0, 0.0, -1.0]), axis=1)
    return np.asarray(distance.reshape(96, 96), np.float32)


def test_one_layer_is_the_opaque_base(ball: FurStudio, shot: Callable[..., Samples]) -> None:
    base, at = shot(layers=1), radius(ball)
    assert set(np.unique(base[..., 3])) == {0.0, 1.0}
    assert (base[..., 3][at < 2.9] == 1.0).all() and (base[..., 3][at > 3.0] == 0.0).all()


def test_shells_reach_as_far_as_the_coat(ball: FurStudio, shot: Callable[..., Samples]) -> None:
    shells, at = shot(fins=False)[..., 3], radius(ball)
    outside = (at > 3.0) & (at < 3.0 + ball.fur.length)
    assert (shells[outside] > 0.0).mean() > 0.2
    assert (shells[at > 3.0 + ball.fur.length] == 0.0).all()
    assert (shells[at < 2.9] == 1.0).all()


def test_fins_show_at_the_silhouette_only(ball: FurStudio, shot: Callable[..., Samples]) -> None:
    without, at = shot(fins=False), radius(ball)
    fins, threshold = shot(fins=True, fin_threshold=0.25), 0.25
    changed = np.abs(fins - without).max(axis=2) > 0.0
    # A facet of this ball may be turned from the sphere's normal by a tenth.
    inner = 3.0 * np.sqrt(1.0 - (threshold + 0.15) ** 2)
    assert not changed[at < inner].any()
    rim = (at > 3.0) & (at < 3.0 + 0.8 * ball.fur.length)
    assert changed[rim].mean() > 0.3
    assert fins[..., 3][rim].mean() > without[..., 3][rim].mean()
    assert (fins[..., 3] >= without[..., 3] - tolerance("fur_half_float")).all()


def test_the_shadow_darkens_towards_the_skin(ball: FurStudio, shot: Callable[..., Samples]) -> None:
    lit, dark = shot(s_min=1.0, fins=False), shot(s_min=0.1, fins=False)
    assert np.array_equal(lit[..., 3], dark[..., 3])
    inside = radius(ball) < 2.5
    assert dark[..., :3][inside].mean() < 0.9 * lit[..., :3][inside].mean()
    assert (dark[..., :3] <= lit[..., :3] + tolerance("fur_half_float")).all()
    base = shot(s_min=1.0, layers=1)
    assert np.abs(shot(s_min=0.5, layers=1)[..., :3] - 0.5 * base[..., :3]).max() < tolerance(
        "fur_half_float"
    )


def test_hairs_without_thickness_leave_the_base(shot: Callable[..., Samples]) -> None:
    assert np.array_equal(shot(thickness=0.0), shot(layers=1))


def test_painted_density_thins_the_coat(ball: FurStudio, shot: Callable[..., Samples]) -> None:
    bald = ball.mesh.vertices.copy()
    bald["density_share"] = np.where(bald["position"][:, 0] > 0.0, 1.0, 0.0)
    fins = ball.mesh.fin_vertices.copy()
    fins["density_share"] = np.where(fins["position"][:, 0] > 0.0, 1.0, 0.0)
    painted = samples(replace(ball, mesh=replace(ball.mesh, vertices=bald, fin_vertices=fins)), "glsl")
    at, x = radius(ball), np.arange(96)[None, :] - 47.5
    rim = (at > 3.05) & (at < 3.3)
    assert (painted[..., 3][rim & (x < -12)] == 0.0).all()
    assert np.array_equal(painted[..., 3][rim & (x > 12)], shot()[..., 3][rim & (x > 12)])


def test_another_seed_is_another_coat_of_the_same_look(shot: Callable[..., Samples]) -> None:
    one, other = shot(seed=1), shot(seed=2)
    assert (np.abs(one - other).max(axis=2) > 0.05).mean() > 0.1
    assert abs(one[..., :3].mean() / other[..., :3].mean() - 1.0) < tolerance("fur_seed")


def test_no_sample_is_odd(shot: Callable[..., Samples]) -> None:
    for picture in (shot(), shot(length=0.0), shot(opacity=0.0), shot(force=(0.0, -4.0, 0.0))):
        assert np.isfinite(picture).all() and picture.min() >= 0.0 and picture[..., 3].max() <= 1.0


def test_the_camera_frames_the_scene() -> None:
    camera = Camera((1.0, 2.0, 10.0), (0.5, 1.0, 0.0), field_of_view=40.0)
    centre, reach = np.array([0.5, 1.0, 0.0]), 3.0
    forward = np.subtract(camera.target, camera.eye)
    forward = forward / np.linalg.norm(forward)
    for depth_from in (-1.0, 0.0):
        matrix = view_projection(camera, 1.5, (centre, reach), depth_from)
        ends = [centre - reach * forward, centre, centre + reach * forward]
        near, middle, far = (matrix @ np.append(point, 1.0) for point in ends)
        assert np.abs(middle[:2] / middle[3]).max() < tolerance("fur_camera")
        assert abs(near[2] / near[3] - depth_from) < tolerance("fur_camera")
        assert abs(far[2] / far[3] - 1.0) < tolerance("fur_camera")
        # The direction through the middle of the upper edge lies on the upper edge.
        upper = camera.directions(1, 4096)[0]
        shown = matrix @ np.append(np.add(camera.eye, 9.0 * upper), 1.0)
        assert abs(shown[1] / shown[3] - (1.0 - 1.0 / 4096.0)) < tolerance("fur_camera")


def test_the_command_draws_fur(tmp_path: Path) -> None:
    need("glsl")
    trimesh.creation.icosphere(subdivisions=2).export(tmp_path / "ball.ply")
    text = FURRY.replace("../data/bunny.obj", "ball.ply").replace("[640, 640]", "[40, 30]")
    text = text.replace("[0.1, 4.75, 0.0]", "[0.0, 0.0, 0.0]").replace("27.0", "8.0")
    (tmp_path / "scene.toml").write_text(text.replace("layers = 32", "layers = 4"), encoding="utf-8")
    output = tmp_path / "ball.png"
    assert run(["render", str(tmp_path / "scene.toml"), "--target", "glsl", "-o", str(output)]) == 0
    with Image.open(output) as image:
        pixels = np.asarray(image).astype(int)
    assert pixels.shape == (30, 40, 3)
    assert pixels[15, 20, 0] > pixels[15, 20, 2] + 10  # brown fur before a grey ground


WRONG: dict[str, tuple[str, str, str]] = {
    "negative length": ("length = 0.5", "length = -0.5", "[fur] length: must be a number from 0 to 100"),
    "no length": ("length = 0.5", "", "[fur] length: is missing"),
    "zero shells": ("layers = 32", "layers = 0", "[fur] layers: must be a whole number from 1 to 256"),
    "nan": ("thickness = 0.9", "thickness = nan", "[fur] thickness: must be a number from 0 to 1, not nan"),
    "infinite": ("spacing = 0.038", "spacing = inf", "[fur] spacing: must be a number from 1e-06 to 1000"),
    "misspelt": ("s_min = 0.2", "smin = 0.2", '[fur] has an unknown key "smin"; did you mean "s_min"?'),
    "bend": ("force = [0.0, -0.45, 0.0]", "force = [9, 0, 0]", "[fur] force: must not be longer than 4"),
    "no direction": ("direction = [0.85, -0.5, -0.15]", "", "[fur.comb] direction: is missing"),
    "channel": ("seed = 7", 'length_channel = "gren"', 'unknown channel "gren"; did you mean "green"?'),
    "surface": (
        "[fur.comb]",
        "[fur.surface]\ncos_dark = 0.5\ncos_lit = 0.1\n[fur.comb]",
        "[fur.surface] cos_dark: must be below cos_lit = 0.1, not 0.5",
    ),
    "size": ("supersample = 2", "supersample = 8\n", "[render] size times supersample may be 8192 at most"),
    "model": ('model = "fakefur"', 'model = "brushed"', '[parameters] "coat.density": brushed_shade has no'),
}


@pytest.mark.parametrize("name", WRONG)
def test_bad_fur_is_refused_in_one_sentence(tmp_path: Path, name: str) -> None:
    right, wrong, sentence = WRONG[name]
    assert right in FURRY
    text = FURRY.replace(right, wrong).replace("../data", str(ROOT / "examples" / "data"))
    text = text.replace("[640, 640]", "[1200, 640]") if name == "size" else text
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UserError) as caught:
        set_up_fur(load_library(), path)
    assert sentence in str(caught.value) and str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_targets_without_stages_and_scenes_without_fur_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    trimesh.creation.icosphere(subdivisions=1).export(tmp_path / "ball.ply")
    text = FURRY.replace("../data/bunny.obj", "ball.ply")
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert run(["render", "scene.toml", "--target", "opncl", "-o", "ball.png"]) == 2
    assert 'unknown target "opncl"; did you mean "opencl"?' in capsys.readouterr().err
    with pytest.raises(UserError, match="target opencl draws no fur; glsl and wgsl do"):
        open_fur(set_up_fur(load_library(), tmp_path / "scene.toml"), "opencl")
    assert run(["fur", str(SCENES / "haired-bunny.toml"), "-o", "kit"]) == 2
    assert "has no [fur] table, which a picture of fur needs" in capsys.readouterr().err
    assert not (tmp_path / "kit").exists() and not (tmp_path / "ball.png").exists()


def test_the_examples_are_read() -> None:
    for name in ("furry-bunny", "shell-lit-bunny"):
        scene = read_scene(SCENES / f"{name}.toml")
        assert scene.fur is not None and scene.picture is not None and len(scene.picture.lights) == 2
    assert read_scene(SCENES / "haired-bunny.toml").fur is None
