"""Scene files: what is read, and one precise sentence for everything that is wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.library import load_library
from codegen.strands.tfx import read_strands
from conformance.picture.backends import models, open_backend
from conformance.picture.mesh import read_mesh
from conformance.picture.scene import Range, read_scene
from conformance.picture.shade import Models, Shading, Slot, bind

SCENES = Path(__file__).parents[3] / "examples" / "scenes"
GOOD = (SCENES / "brushed-bunny.toml").read_text(encoding="utf-8")


def written(folder: Path, text: str) -> Path:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("path", sorted(SCENES.glob("*.toml")), ids=lambda path: path.stem)
def test_the_example_scenes_are_good(path: Path) -> None:
    scene = read_scene(path)
    shading = bind(scene, models(load_library()))
    assert shading.function == f"{scene.model}_shade"
    assert scene.picture is not None
    if scene.hair is not None:
        assert read_strands(scene.picture.mesh).shape == (743, 32, 3)
    else:
        assert read_mesh(scene.picture.mesh).triangles.shape == (3674, 3)


def test_a_scene_without_a_picture_may_be_short(tmp_path: Path) -> None:
    text = '[shade]\nmodel = "banks"\n[lights]\npoint = 2\nenvironment = "dawn.exr"\n'
    scene = read_scene(written(tmp_path, text))
    assert (scene.name, scene.picture, scene.budget) == ("scene", None, None)
    assert scene.targets == ("glsl", "wgsl", "opencl")


def test_a_range_is_shown_at_its_middle(tmp_path: Path) -> None:
    text = GOOD.replace("exponent = 16.0", "exponent = { min = 8, max = 16 }")
    scene = read_scene(written(tmp_path, text))
    assert scene.parameters["exponent"] == Range(8.0, 16.0)
    assert bind(scene, models(load_library())).values["exponent"] == (12.0,)


WRONG = [
    ("[render]", "[rendr]", 'unknown table or key "rendr"; did you mean "render"?'),
    ("[scene]", "scene = 1\n[scenes]", "scene must be a table, written [scene]"),
    ("[scene]", "[scene", "is not valid TOML: "),
    ('model = "brushed" ', 'modle = "brushed" ', '[shade] model: is missing; did you mean "modle"?'),
    ('model = "brushed" ', "model = 3 ", "[shade] model: must be a text, not 3"),
    ('targets = ["glsl", "wgsl", "opencl"]', 'targets = ["glsl", "wsgl"]', 'did you mean "wgsl"?'),
    ('targets = ["glsl", "wgsl", "opencl"]', 'targets = "glsl"', "must be an array of targets"),
    ('budget = "half-step-8bit"', 'budget = "half-step"', 'did you mean "half-step-8bit"?, or a number'),
    ('budget = "half-step-8bit"', "budget = -1", "[scene] budget: must be a number from 0 to"),
    ("exponent = 16.0", "exponent = true", '[parameters] "exponent": must be a number, a vector'),
    ("exponent = 16.0", "exponent = { min = 9, max = 2 }", "min = 9 is above max = 2"),
    ("exponent = 16.0", "exponent = { mni = 9, max = 2 }", 'min: is missing; did you mean "mni"?'),
    ("directional = 1", "directional = 2", "[lights] directional: is 2, but [[render.light]] lists 1"),
    ("directional = 1", "point = 1", "[lights] point: a picture is lit by directional lights and"),
    ("size = [768, 768]", "size = [768, 0]", "[render] size: must be [width, height] from 1 to 4096"),
    ("size = [768, 768]", "size = 768", "[render] size: must be [width, height] from 1 to 4096"),
    ("supersample = 2 ", "supersample = 2.5 ", "[render] supersample: must be a whole number from 1 to 8"),
    ("shadows = true", 'shadows = "yes"', '[render] shadows: must be true or false, not "yes"'),
    ("shadows = true", "shadow = true", '[render] has an unknown key "shadow"; did you mean "shadows"?'),
    ("field_of_view = 25.5", "fov = 25.5", '[render.camera] has an unknown key "fov"'),
    ("field_of_view = 25.5", "field_of_view = 0", "must be a number from 0.1 to 170, not 0"),
    ("eye = [-7.0, 9.5, 24.0]", "eye = [-7.0, 9.5]", "[render.camera] eye: must be three numbers"),
    ("eye = [-7.0, 9.5, 24.0]", "eye = [0.1, 4.55, 0.0]", "[render.camera] target: is where the eye is"),
    ("up = [0.0, 1.0, 0.0]", "up = [0, 0, 0]", "[render.camera] up: must be a direction"),
    ("up = [0.0, 1.0, 0.0]", "up = [7.1, -4.95, -24.0]", "[render.camera] up: points along the view"),
    ("[[render.light]]", "[render.light]", "must be an array of tables, each written [[render.light]]"),
    ("[render.brush]", "[render.bursh]", 'did you mean "brush"?'),
]


@pytest.mark.parametrize(("good", "wrong", "sentence"), WRONG, ids=[w for _, w, _ in WRONG])
def test_a_fault_is_named_with_file_and_key(tmp_path: Path, good: str, wrong: str, sentence: str) -> None:
    assert good in GOOD
    path = written(tmp_path, GOOD.replace(good, wrong))
    with pytest.raises(UserError) as caught:
        read_scene(path)
    assert str(caught.value).startswith(str(path))
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_picture_needs_a_light(tmp_path: Path) -> None:
    text = GOOD.partition("[[render.light]]")[0]
    with pytest.raises(UserError, match=r"\[\[render\.light\]\] is missing"):
        read_scene(written(tmp_path, text))


UNBINDABLE = [
    (
        'model = "brushed" ',
        'model = "bruhsed" ',
        'no shading function is called "bruhsed"; did you mean "brushed"?',
    ),
    ("exponent = 16.0", "exponnet = 11.0", 'brushed_shade has no such parameter; did you mean "exponent"?'),
    ("exponent = 16.0", "", '[parameters] "exponent": is missing; brushed_shade needs it'),
    ("exponent = 16.0", "exponent = [1.0, 2.0]", '"exponent": must be a number'),
    (
        "exponent = 16.0",
        "exponent = -1.0",
        '"exponent": must lie in [0, 100000], where brushed_shade is',
    ),
    ("exponent = 16.0", "exponent = { min = 1, max = 1e9 }", '"exponent": must lie in [0, 100000]'),
    ("k_diffuse = [0.15, 0.048, 0.020]", "k_diffuse = 0.1", '"k_diffuse": must be a vector of 3 numbers'),
    ("exponent = 16.0", "n = [0, 0, 1]", '"n": is supplied by the picture for every sample'),
]


@pytest.mark.parametrize(("good", "wrong", "sentence"), UNBINDABLE, ids=[w for _, w, _ in UNBINDABLE])
def test_a_parameter_the_library_does_not_know(tmp_path: Path, good: str, wrong: str, sentence: str) -> None:
    scene = read_scene(written(tmp_path, GOOD.replace(good, wrong)))
    with pytest.raises(UserError) as caught:
        bind(scene, models(load_library()))
    assert str(caught.value).startswith(str(scene.path))
    assert sentence in str(caught.value)


def test_fields_of_structs_are_dotted(tmp_path: Path) -> None:
    text = '[shade]\nmodel = "coat"\n[parameters]\n"coat.density" = 3.0\n"coat.tint" = [1, 2, 3]\n'
    slots = (Slot("n", 3), Slot("coat.density", 1), Slot("coat.tint", 3))
    shading: Shading = bind(read_scene(written(tmp_path, text)), Models(("coat_shade",), lambda name: slots))
    inputs: dict[str, Any] = shading.inputs({"n": np.zeros((5, 3), np.float32)}, slice(1, 3))
    assert inputs["n"].shape == (2, 3)
    np.testing.assert_array_equal(inputs["coat"]["density"], np.full(2, 3.0, np.float32))
    np.testing.assert_array_equal(inputs["coat"]["tint"], np.array([[1, 2, 3], [1, 2, 3]], np.float32))


def test_unreadable_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="there is no such file"):
        read_scene(tmp_path / "absent.toml")
    with pytest.raises(UserError, match="cannot be read"):
        read_scene(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UserError, match="not a text file in UTF-8"):
        read_scene(tmp_path / "binary.toml")


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("mesh.obj", "nothing to see\n", "holds no triangles"),
        ("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n", "has a vertex that is not finite"),
        ("mesh.obj", "v 0 0 0\nf 1 2 9\n", "cannot be read as a mesh"),
        ("mesh.ply", "ply\n", "cannot be read as a mesh"),
        ("mesh.unheard-of", "v 0 0 0\n", "cannot be read as a mesh"),
    ],
)
def test_unreadable_meshes_are_named(tmp_path: Path, name: str, content: str, sentence: str) -> None:
    path = tmp_path / name
    path.write_text(content, encoding="utf-8")
    with pytest.raises(UserError) as caught:
        read_mesh(path)
    assert str(caught.value).startswith(str(path))
    assert sentence in str(caught.value)


def test_an_absent_mesh_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="there is no such mesh file"):
        read_mesh(tmp_path / "bunny.obj")


def test_an_unknown_backend_is_named() -> None:
    with pytest.raises(UserError, match='unknown target "numpy64"; did you mean "numpy'):
        open_backend("numpy64", load_library())
