"""Scene files for `vair scene`: what is read, and one sentence for everything that is wrong.

Plan. A good file; then one change at a time, with the part of the sentence that names key and nearest name.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.errors import UserError
from codegen.library import load_library
from codegen.scene.description.document import BUDGETS, HALF_STEP, Scene, read_scene
from codegen.scene.description.settings import Alias, Constant, Range

GOOD = """
[scene]
name = "fox at noon"
targets = ["glsl", "opencl"]
budget = "half-step-8bit"

[shade]
model = "fakefur"

[parameters]
"optics.rho_reflect" = 0.5
"optics.rho_transmit" = { min = 0.25, max = 0.5 }
"optics.exponent" = 32.0
"optics.k_specular" = [0.5, 0.25, 0.125]
"optics.k_diffuse" = { min = 0.0, max = [0.5, 0.5, 1.0] }

[view]
min_n_dot_v = 0.05

[lights]
directional = 2
point = 1
per_light = ["skin"]
"""


def read(folder: Path, text: str) -> Scene:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return read_scene(path, load_library())


def test_a_good_scene(tmp_path: Path) -> None:
    scene = read(tmp_path, GOOD)
    assert (scene.function, scene.model.function.name) == ("fox_at_noon_shade", "fakefur_shade")
    assert scene.dialects == {"glsl": "430", "opencl": "1.2"}
    assert scene.budget == HALF_STEP == BUDGETS["half-step-8bit"]
    assert scene.settings == {
        "optics.rho_reflect": Constant((0.5,)),
        "optics.rho_transmit": Range((0.25,), (0.5,)),
        "optics.exponent": Constant((32.0,)),
        "optics.k_specular": Constant((0.5, 0.25, 0.125)),
        "optics.k_diffuse": Range((0.0, 0.0, 0.0), (0.5, 0.5, 1.0)),
    }
    assert scene.facts == {("n", "v"): (0.05, 1.0)}
    assert (scene.lights.directional, scene.lights.point, scene.lights.per_light) == (2, 1, ("skin",))


def test_what_is_not_said_has_defaults(tmp_path: Path) -> None:
    scene = read(tmp_path, '[shade]\nmodel = "kajiya_kay_shade"\n')
    assert (scene.name, scene.budget, scene.lights.directional) == ("scene", 0.0, 1)
    assert list(scene.dialects) == ["glsl", "wgsl", "opencl"]


def test_aliases_lead_to_their_end(tmp_path: Path) -> None:
    text = '[shade]\nmodel = "fakefur"\n[parameters]\nt = "n"\n"optics.rho_transmit" = "optics.rho_reflect"\n'
    text += '"optics.rho_reflect" = "optics.overlap"\n"optics.rho_surface" = "optics.cos_lit"\n'
    text += '"optics.cos_lit" = 0.25\n[view]\nmin_t_dot_v = 0.5\n'
    scene = read(tmp_path, text)
    assert scene.settings["optics.rho_transmit"] == Alias("optics.overlap")
    assert scene.settings["optics.rho_surface"] == Constant((0.25,))
    assert scene.facts == {("n", "v"): (0.5, 1.0)}


WRONG = [
    (
        'model = "fakefur"',
        'model = "fakefir"',
        '[shade] model: unknown model "fakefir"; did you mean "fakefur"?',
    ),
    ('model = "fakefur"', 'model = "fur_opacity"', 'unknown model "fur_opacity"'),
    ('model = "fakefur"', 'modle = "fakefur"', '[shade] model: is missing; did you mean "modle"?'),
    ("[shade]", "[shader]", 'unknown table or key "shader"; did you mean "shade"?'),
    ('"opencl"]', '"openlc"]', '[scene] targets: unknown target "openlc"; did you mean "opencl"?'),
    ('"half-step-8bit"', '"half-step"', '[scene] budget: unknown budget "half-step"; did you mean'),
    ('"half-step-8bit"', "-1.0", "[scene] budget: must be a number from 0"),
    ("budget =", "buget =", '[scene] has an unknown key "buget"; did you mean "budget"?'),
    ("[shade]", '[scene.dialects]\nglsl = "331"\n[shade]', 'unknown glsl dialect "331"'),
    ("[shade]", '[scene.dialects]\nwgsl = "wgsl"\n[shade]', "wgsl: is no target of this scene"),
    ("[shade]", '[shade]\nfunction = "fakefur_shade"', '"fakefur_shade" is a name of the library'),
    ("[shade]", '[shade]\nfunction = "Fox"', '"Fox" must be snake_case'),
    ('"optics.exponent"', '"optics.exponnet"', 'no such parameter; did you mean "optics.exponent"?'),
    ('"optics.exponent"', '"exponent"', 'did you mean "optics.exponent"?'),
    ('"optics.exponent"', "light", "comes from the lights of the scene"),
    ("= 32.0", '= "optics.exponents"', '"optics.exponents" is no parameter to be equal to'),
    ("= 32.0", '= "optics.exponent"', '"optics.exponent" is itself'),
    ("= 32.0", '= "skin"', '"skin" is a vec3; it must be another f32'),
    ("= 32.0", '= "coat.density"', "reaches 0 to 1e9, but this parameter is in [0, 100000]"),
    ("= 32.0", "= [1.0, 2.0]", "must be a number, a range or another parameter, not [1.0, 2.0]"),
    ("= 32.0", "= 1e6", "1000000 is outside its domain"),
    ("= 32.0", "= 1e39", "is beyond float32"),
    ("= 32.0", "= nan", "must be a number"),
    ("min = 0.25, max = 0.5", "min = 0.75, max = 0.5", "min = 0.75 is above max = 0.5"),
    ("min = 0.25, max = 0.5", "min = 0.25, max = 1.5", "max: 1.5 is outside its domain: in [0, 1]"),
    ("min = 0.25, max = 0.5", "min = 0.25", "a range needs max"),
    ("min = 0.25, max = 0.5", "min = 0.25, top = 0.5", 'unknown key "top" of a range'),
    ("[0.5, 0.25, 0.125]", "[0.5, 0.25]", "must be 3 numbers, not [0.5, 0.25]"),
    ("[0.5, 0.25, 0.125]", "[0.5, 0.25, 2.0]", "[0.5, 0.25, 2] is outside its domain"),
    ("[0.5, 0.25, 0.125]", "0.5", "must be 3 numbers"),
    ("[parameters]", "[parameters]\nn = [0.0, 0.0, 2.0]", "has length 2; it must be a unit vector"),
    ("[parameters]", "[parameters]\nn = { min = 0.0, max = 1.0 }", "is a direction: give a constant"),
    (
        "[parameters]",
        '[parameters]\n"optics.cos_lit" = "optics.cos_dark"\n"optics.cos_dark" = "optics.cos_lit"',
        "leads back to itself: optics.cos_lit = optics.cos_dark = optics.cos_lit",
    ),
    ("min_n_dot_v", "min_n_dot_w", 'is no fact about directions; did you mean "min_n_dot_'),
    ("min_n_dot_v", "least_cosine", "facts are written like min_n_dot_v = 0.05"),
    ("min_n_dot_v = 0.05", "min_n_dot_v = 1.5", "must be a number from -1 to 1"),
    ("min_n_dot_v = 0.05", "min_n_dot_v = 0.5\nmax_v_dot_n = 0.25", "0.5 contradicts max_n_dot_v = 0.25"),
    (
        "min_n_dot_v = 0.05",
        "min_n_dot_v = 0.9\nmin_n_dot_l = 0.9\nmax_l_dot_v = 0.0",
        "contradicts min_l_dot_n and min_n_dot_v: no three directions are like that",
    ),
    (
        "min_n_dot_v = 0.05",
        "max_n_dot_v = -0.9\nmax_n_dot_l = -0.9\nmax_l_dot_v = -0.9",
        "no three directions are like that",
    ),
    (
        "[parameters]",
        "[parameters]\nn = [0.0, 0.0, 1.0]\nv = [0.0, 0.0, -1.0]",
        "contradicts the constants of n and v, whose cosine is -1",
    ),
    (
        "directional = 2",
        "directonal = 2",
        '[lights] has an unknown key "directonal"; did you mean "directional"?',
    ),
    ("directional = 2", "directional = -1", "must be a whole number from 0 to 64"),
    ("directional = 2\npoint = 1", "directional = 0", "the scene has no light at all"),
    ("directional = 2", "environment_lights = 4", "environment_lights: needs a map"),
    ("directional = 2", "colour = { min = 2, max = 1 }", "min = 2 is above max = 1"),
    ("directional = 2", "colour = [1.0, -1.0, 1.0]", "must be three numbers from 0 to 10000"),
    ("point = 1", "distance = { min = 1, max = 2 }", "belongs to point lights, and the scene has none"),
    ('["skin"]', '["skim"]', 'has no parameter "skim"; did you mean "skin"?'),
    ('["skin"]', '["light"]', "belongs to each light anyway"),
    ('["skin"]', '"skin"', "must be an array of parameters"),
]


@pytest.mark.parametrize(("old", "new", "part"), WRONG, ids=[f"{k}" for k in range(len(WRONG))])
def test_one_sentence_for_what_is_wrong(tmp_path: Path, old: str, new: str, part: str) -> None:
    assert old in GOOD
    with pytest.raises(UserError) as caught:
        read(tmp_path, GOOD.replace(old, new, 1))
    sentence = str(caught.value)
    assert part in sentence, sentence
    assert "scene.toml" in sentence
    assert "\n" not in sentence


def test_a_model_without_a_light_refuses_nothing_else(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="there is no such file"):
        read_scene(tmp_path / "absent.toml", load_library())
