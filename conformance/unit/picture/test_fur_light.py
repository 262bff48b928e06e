"""Light from environment maps and cast shadows on fur: alike in every way of drawing, and where they belong.

Plan.
  agreement  the scene with both: OpenGL against WebGPU, and against rays on the evaluator and OpenCL
  map        its lights stand behind the listed ones, scaled; more lights come closer to the whole map; one
             lookup along the normal cannot replace them
  surfaces   a scene without fur is lit by a map too, and by nothing else if it lists no light
  shadows    they darken and never brighten; a ball over a plate: dark below the ball, light beside it; lights
             beyond the third share one value; the disc of a light is even
  stages     room for every light; nothing of shadows where there are none
  refused    maps that are missing, no map or black, keys without a map, too many lights
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from codegen.errors import UserError
from codegen.fur.coat import FurMesh, grow
from codegen.fur.layout import FIN_VERTEX, FUR_VERTEX, MOST_LIGHTS
from codegen.fur.stages import stage_texts
from codegen.library import load_library
from codegen.maps.image import exr
from conformance.bench.fur.sky import errors
from conformance.picture.backends import models, open_backend
from conformance.picture.fur.draw import draw_fur
from conformance.picture.fur.shadow import HALF_ANGLE, disc, with_shadows
from conformance.picture.fur.studio import FurStudio, set_up_fur
from conformance.picture.render import set_up
from conformance.picture.scene import Light
from conformance.picture.tolerances import tolerance
from conformance.picture.tone import steps_apart
from conformance.unit.support.drivers import need
from targets import TargetUnavailable, probe

SCENE = Path(__file__).parents[3] / "examples" / "scenes" / "dawn-bunny.toml"
DAWN = SCENE.read_text(encoding="utf-8")
LIBRARY = load_library()
ABOVE = Light((0.0, 1.0, 0.0), (1.0, 1.0, 1.0))


@pytest.fixture(scope="module")
def dawn() -> FurStudio:
    made = set_up_fur(LIBRARY, SCENE, size=(52, 52), supersample=1, subdivide=0)
    return replace(made, fur=replace(made.fur, layers=4))


@pytest.fixture(scope="module")
def drawn(dawn: FurStudio) -> dict[str, Any]:
    """The picture by target, where there is a driver."""
    few = replace(dawn, picture=replace(dawn.picture, lights=dawn.picture.lights[:4]))
    found = {"numpy32": draw_fur(few, "numpy32")[0]}
    for target in ("glsl", "wgsl", "opencl"):
        if not isinstance(probe(target), TargetUnavailable):
            found[target] = draw_fur(few, target)[0]
    return found


@pytest.mark.parametrize(
    ("one", "other", "share"),
    [
        ("glsl", "wgsl", "fur_pixel_share"),
        ("glsl", "numpy32", "fur_march_share"),
        ("opencl", "numpy32", "fur_pixel_share"),
    ],
)
def test_every_way_draws_the_same_light(drawn: dict[str, Any], one: str, other: str, share: str) -> None:
    need(*(target for target in (one, other) if target != "numpy32"))
    pictures = [drawn[target][..., :3].astype(np.float64) for target in (one, other)]
    assert pictures[0].max() > 0.1 and np.isfinite(pictures).all()
    steps = steps_apart(*pictures)
    assert steps.mean() < tolerance("fur_mean_steps")
    assert (steps.max(axis=2) < tolerance("fur_pixel_steps")).mean() > tolerance(share)


def test_the_lights_of_a_map_stand_behind_the_listed_ones(dawn: FurStudio, tmp_path: Path) -> None:
    assert dawn.scene.picture is not None
    listed, lights = dawn.scene.picture.lights, dawn.picture.lights
    assert lights[: len(listed)] == listed and len(lights) == 2 + 14
    text = DAWN.replace("../data", str(SCENE.parents[1] / "data"))
    half = tmp_path / "half.toml"
    half.write_text(text.replace("environment_scale = 0.6", "environment_scale = 0.3"), encoding="utf-8")
    darker = set_up_fur(LIBRARY, half, subdivide=0).picture.lights[2:]
    assert [light.direction for light in darker] == [light.direction for light in lights[2:]]
    colours = [np.array([light.colour for light in some]) for some in (darker, lights[2:])]
    assert np.array_equal(2.0 * colours[0], colours[1])


def test_more_lights_come_closer_to_the_map(dawn: FurStudio) -> None:
    found = errors(dawn, (2, 32), points=12, rows=8)
    assert found.by_lights[32] < tolerance("fur_sky_lights")
    assert found.by_lights[2] > 2.0 * found.by_lights[32] and found.lookup > 2.0 * found.by_lights[32]


def test_a_map_alone_lights_a_surface(tmp_path: Path) -> None:
    text = (SCENE.parent / "brushed-bunny.toml").read_text(encoding="utf-8")
    text = text[: text.index("[[render.light]]")].replace("../data", str(SCENE.parents[1] / "data"))
    text = text.replace("directional = 1", f'environment = "{SCENE.parents[1] / "data" / "dawn.exr"}"')
    path = tmp_path / "scene.toml"
    path.write_text(text.replace("[768, 768]", "[24, 24]").replace("subdivide = 2", "subdivide = 0"))
    studio = set_up(path, models(LIBRARY))
    assert len(studio.picture.lights) == 8 == len(studio.seen.l)
    shaded = studio.shade(open_backend("numpy", LIBRARY))
    assert np.isfinite(shaded).all() and 0.05 < shaded.mean() < 1.0


def test_shadows_only_darken(dawn: FurStudio) -> None:
    need("glsl")
    bright = replace(dawn, shading=replace(dawn.shading, shadowed=False))
    with_them, without = (draw_fur(made, "glsl")[0] for made in (dawn, bright))
    assert np.array_equal(with_them[..., 3], without[..., 3])
    darker = without[..., :3] - with_them[..., :3]
    assert darker.min() > -tolerance("fur_half_float")
    assert (darker.max(axis=2) > 0.02).mean() > 0.04


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> FurMesh:
    """A ball of radius 1 at height 3 over a plate of 8 x 8."""
    ball = trimesh.creation.icosphere(subdivisions=2)
    ball.apply_translation((0.0, 3.0, 0.0))
    side = np.linspace(-4.0, 4.0, 17)
    x, z = np.meshgrid(side, side, indexing="ij")
    corners = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
    a = (17 * np.arange(16)[:, None] + np.arange(16)).reshape(-1)
    squares = np.concatenate([np.stack([a, a + 1, a + 17], 1), np.stack([a + 1, a + 18, a + 17], 1)])
    path = tmp_path_factory.mktemp("table") / "table.ply"
    both: Any = trimesh.util.concatenate([ball, trimesh.Trimesh(corners, squares, process=False)])
    both.export(path)
    return grow(path, spacing=0.1)


def test_a_ball_casts_its_shadow_below_it(table: FurMesh) -> None:
    shadowed = with_shadows(table, [ABOVE], 0.1)
    vertices = shadowed.vertices
    plate = vertices["position"][:, 1] == 0.0
    assert (vertices["normal"][plate] @ np.array([0, 1, 0], np.float32) > 0.9).all()
    away = np.linalg.norm(vertices["position"][:, [0, 2]], axis=1)
    lit = vertices["lit"]
    reach = 3.0 * np.tan(HALF_ANGLE)  # how much wider than the ball half shadow is
    assert (lit[plate & (away < 0.9 - reach), 0] == 0.0).all()
    assert (lit[plate & (away > 1.1 + reach), 0] == 1.0).all()
    top = vertices["position"][:, 1] > 3.0
    assert (lit[top, 0] == 1.0).all() and (lit[:, 1:] == 1.0).all()
    low = (vertices["position"][:, 1] < 2.5) & ~plate
    assert (lit[low, 0] == 0.0).all()  # the ball itself is in the way
    names = shadowed.fin_vertices.dtype.names or ()
    assert names == (*(FIN_VERTEX.names or ()), "lit")
    assert [n for n in vertices.dtype.names or () if n != "lit"] == list(FUR_VERTEX.names or ())


def test_fins_stand_in_the_same_shadow(table: FurMesh) -> None:
    shadowed = with_shadows(table, [ABOVE], 0.1)
    shares = {tuple(v["position"].tolist()): v["lit"].tolist() for v in shadowed.vertices}
    assert all(shares[tuple(v["position"].tolist())] == v["lit"].tolist() for v in shadowed.fin_vertices)
    again = with_shadows(shadowed, [ABOVE], 0.1)
    assert np.array_equal(again.vertices, shadowed.vertices)


def test_lights_beyond_the_third_share_a_shadow(table: FurMesh) -> None:
    sideways = Light((1.0, 0.02, 0.0), (1.0, 1.0, 1.0))
    three = [ABOVE, sideways, sideways]
    plain = with_shadows(table, [*three, ABOVE], 0.1).vertices["lit"]
    assert np.isin(plain[:, 3], (0.0, 1.0)).all()
    mixed = with_shadows(table, [*three, ABOVE, replace(sideways, colour=(3.0, 3.0, 3.0))], 0.1)
    values = np.unique(np.round(mixed.vertices["lit"][:, 3], 6)).tolist()
    assert values == [0.0, 0.25, 0.75, 1.0]  # by luminance: neither, one, the other, both
    dark = with_shadows(table, [*three, replace(ABOVE, colour=(0.0, 0.0, 0.0))], 0.1)
    assert (dark.vertices["lit"][:, 3] == 1.0).all()


def test_the_disc_of_a_light_is_even() -> None:
    towards = np.array([0.3, -0.8, 0.5])
    found = disc(tuple(3.0 * towards))
    assert np.abs(np.linalg.norm(found, axis=1) - 1.0).max() < tolerance("fur_comb")
    angle = np.arccos(np.clip(found @ (towards / np.linalg.norm(towards)), -1.0, 1.0))
    assert 0.9 * HALF_ANGLE < angle.max() < HALF_ANGLE
    mean = found.mean(axis=0)
    assert np.arccos(mean @ towards / np.linalg.norm(mean) / np.linalg.norm(towards)) < 0.1 * HALF_ANGLE


def test_stages_hold_what_a_scene_needs(dawn: FurStudio) -> None:
    open_air = replace(dawn.shading, lights=8, shadowed=False)
    for target, dialect in (("glsl", "330"), ("wgsl", "wgsl")):
        lit = "\n".join(stage_texts(LIBRARY, dawn.shading, target, dialect).values())
        plain = "\n".join(stage_texts(LIBRARY, open_air, target, dialect).values())
        assert ("light_colour[16]" in lit) or ("light_colour: array<vec4<f32>, 16>" in lit)
        assert "lit" in lit.split() or "at_lit;" in lit.split()
        assert "_lit" not in plain.replace("cos_lit", "") and "//?" not in lit + plain
    assert dawn.fixed().shading.shadowed and dawn.fixed().shading.lights == 16
    assert len(dawn.block.pack(dawn.values("glsl"))) == dawn.block.size


WRONG: dict[str, tuple[str, str, str]] = {
    "missing": ("dawn.exr", "dusk.exr", '[lights] environment: cannot read "'),
    "no map": ("data/dawn.exr", "data/bunny.obj", "[lights] environment: cannot read"),
    "black": ("../data/dawn.exr", "BLACK", '"black.exr" is black: no light comes from it'),
    "square": ("../data/dawn.exr", "SQUARE", "a map in latitude and longitude is twice as wide as high"),
    "no lights": ("environment_lights = 14", "environment_lights = 0", "must be a whole number from 1 to 64"),
    "count alone": ('environment = "../data/dawn.exr"', "", "[lights] environment_lights: needs a map"),
    "scale": (
        "environment_scale = 0.6",
        "environment_scale = nan",
        "must be a number from 0 to 10000",
    ),
    "too many": ("environment_lights = 14", "environment_lights = 64", f"at most {MOST_LIGHTS} lights, not"),
}


@pytest.mark.parametrize("name", WRONG)
def test_bad_light_is_refused_in_one_sentence(tmp_path: Path, name: str) -> None:
    right, wrong, sentence = WRONG[name]
    assert right in DAWN
    for file, shape in (("black", (4, 8, 3)), ("square", (4, 4, 3))):
        (tmp_path / f"{file}.exr").write_bytes(exr(np.zeros(shape)))
        wrong = wrong.replace(file.upper(), str(tmp_path / f"{file}.exr"))
    text = DAWN.replace(right, wrong).replace("../data", str(SCENE.parents[1] / "data"))
    path = tmp_path / "scene.toml"
    path.write_text(text.replace("subdivide = 2", "subdivide = 0"), encoding="utf-8")
    with pytest.raises(UserError) as caught:
        made = set_up_fur(LIBRARY, path)
        made.values("glsl")
    assert sentence in str(caught.value) and "\n" not in str(caught.value)
