"""Scenes end to end without a device: neutral terms, the search, lights, files, refusals.

Plan.
  neutral terms  every combination of the terms of fakefur_shade that can be neutral, pairs by default: what
                 they need is gone, and the exact function lies within the intervals of the general one
  search         a budget is kept, an absent one takes nothing, a larger one never costs more
  lights         each light has its inputs; many are arrays; point lights follow the inverse square; a map's
                 lights bring its energy
  files          the same to the byte; nothing is written where something is refused
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.ir.verify import verify
from codegen.library import load_library
from codegen.maps.image import exr
from codegen.passes.analysis.operations import operations
from codegen.scene import build, environment
from codegen.scene.build import Builder, Outcome
from codegen.scene.description.document import Scene, read_scene
from codegen.scene.general import general_function
from codegen.scene.proof.errors import Measured
from codegen.scene.proof.points import draw
from codegen.scene.proof.proof import Proof, prove
from codegen.scene.reduction.prices import Prices
from codegen.scene.reduction.reduce import Reduced, Reducer
from conformance.unit.support.tolerances import floor, tolerance

NEUTRAL = {
    "no highlight": ('"optics.k_specular" = [0.0, 0.0, 0.0]', {"k_specular", "exponent"}),
    "no diffuse": ('"optics.k_diffuse" = [0.0, 0.0, 0.0]', {"k_diffuse"}),
    "no body shadow": ('"optics.rho_surface" = 0.0', {"rho_surface", "cos_dark", "cos_lit"}),
    "no sides": ('"optics.rho_transmit" = "optics.rho_reflect"', {"rho_transmit"}),
    "no overlap": ('"optics.overlap" = 0.0', {"overlap"}),
    "no skin": ("skin = [0.0, 0.0, 0.0]", {"skin"}),
    "upright": ('t = "n"', {"t"}),
}
POINTS = 300


def scene_of(folder: Path, text: str) -> Scene:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return read_scene(path, load_library())


def reducer(scene: Scene, count: int = POINTS) -> Reducer:
    general = general_function(scene)
    library = load_library().with_functions([general.function])
    return Reducer.of(library, scene, general, draw(scene, general, count))


def reduced(scene: Scene, target: str = "glsl", count: int = POINTS) -> Reduced:
    made = reducer(scene, count)
    return made.reduced(Prices(made.library, target), scene.budget)


def built(scene: Scene) -> Outcome:
    return Builder(load_library(), scene, dict.fromkeys(scene.dialects, "not asked for")).build()


EVERY = [c for size in range(len(NEUTRAL) + 1) for c in itertools.combinations(NEUTRAL, size)]
DARK = {"no highlight", "no diffuse"}
"""Hairs that reflect nothing: all their other properties go too."""
COMBINATIONS = [
    pytest.param(c, id="+".join(c) or "none", marks=[] if len(c) in (0, 1, 2, 6) else pytest.mark.nightly)
    for c in EVERY
    if not set(c) >= DARK
]


@pytest.mark.parametrize("chosen", COMBINATIONS)
def test_neutral_terms_go_with_their_inputs(tmp_path: Path, chosen: tuple[str, ...]) -> None:
    text = '[shade]\nmodel = "fakefur"\n[parameters]\n' + "\n".join(NEUTRAL[name][0] for name in chosen)
    scene = scene_of(tmp_path, text)
    made = reducer(scene, 100)
    exact = made.exact().function
    left = {p.name for p in exact.parameters}
    gone = set().union(*(NEUTRAL[name][1] for name in chosen)) if chosen else set()
    assert left == {p.name for p in made.general.function.parameters} - gone
    library = made.library.with_functions([exact])
    inputs = made.reference.points.inputs
    got = evaluate(library, exact.name, {p.name: inputs[p.name] for p in exact.parameters}, "float32")
    allowed = permitted(library, made.general.function.name, inputs, DEFAULT_TABLES["wgsl"])
    assert allowed.contains(got).all()


def test_neutral_terms_cost_nothing(tmp_path: Path) -> None:
    text = '[shade]\nmodel = "fakefur"\n[parameters]\n'
    all_of_them = text + "\n".join(line for line, _ in NEUTRAL.values() if "k_diffuse" not in line)
    counts = [
        sum(operations(reducer(scene_of(tmp_path, t), 60).exact().function).values())
        for t in (text, all_of_them)
    ]
    assert 2 * counts[1] < counts[0]


FUR = """
[scene]
budget = BUDGET
targets = ["TARGET"]
[shade]
model = "fakefur"
[parameters]
"optics.exponent" = 32.0
"coat.density" = 500.0
"coat.hair_length" = 0.5
"coat.radius_base" = 0.008
"coat.radius_tip" = 0.002
[view]
min_n_dot_v = 0.05
min_n_dot_l = 0.05
"""


def test_a_budget_is_used_and_kept(tmp_path: Path) -> None:
    made = reducer(scene_of(tmp_path, FUR.replace("BUDGET", "0.0").replace("TARGET", "glsl")))
    for target in ("glsl", "wgsl", "opencl"):
        prices = Prices(load_library(), target)
        paid = []
        for budget in (0.0, 1e-5, 1e-3, 2e-3):
            found = made.reduced(prices, budget)
            assert bool(found.changes) == (budget > 0.0)
            assert budget == 0.0 or found.error.fits(budget)
            verify(found.final.function, lambda name: None)
            paid.append(prices.body(found.final.function))
        assert paid == sorted(paid, reverse=True)
        assert paid[-1] < 0.8 * paid[0]


def test_a_whole_exponent_becomes_products(tmp_path: Path) -> None:
    found = reduced(scene_of(tmp_path, FUR.replace("BUDGET", "1e-4").replace("TARGET", "glsl")))
    assert found.changes[0].kind == "power"
    assert "5 multiplications" in found.changes[0].what


def test_terms_that_hardly_vary_become_numbers(tmp_path: Path) -> None:
    text = (
        FUR.replace("BUDGET", "1e-2")
        .replace("TARGET", "glsl")
        .replace("[view]", "skin = [1e-3, 1e-3, 1e-3]\n[view]")
    )
    found = reduced(scene_of(tmp_path, text))
    assert "skin" not in {p.name for p in found.final.function.parameters}
    assert any(change.kind == "term" for change in found.changes)


def test_each_light_has_its_inputs(tmp_path: Path) -> None:
    text = '[shade]\nmodel = "shell"\n[lights]\ndirectional = 1\npoint = 2\nper_light = ["k_diffuse"]\n'
    names = [p.name for p in general_function(scene_of(tmp_path, text)).function.parameters]
    assert names == [
        *("n", "p_diffuse", "k_specular", "p_specular", "v", "position", "l_0", "light_0", "k_diffuse_0"),
        *("light_position_1", "light_1", "k_diffuse_1", "light_position_2", "light_2", "k_diffuse_2"),
    ]


def test_many_lights_are_a_loop_that_adds_up_single_ones(tmp_path: Path) -> None:
    text = '[shade]\nmodel = "banks"\n[lights]\ndirectional = DIRECTIONAL\npoint = POINT\n'
    many = scene_of(tmp_path, text.replace("DIRECTIONAL", "5").replace("POINT", "6"))
    general = general_function(many)
    assert {p.name: p.type.name for p in general.function.parameters if "light" in p.name} == {
        "light_directions": "vec3[5]",
        "light_colours": "vec3[5]",
        "light_positions_5": "vec3[6]",
        "light_colours_5": "vec3[6]",
    }
    library = load_library().with_functions([general.function])
    points = draw(many, general, 50)
    total = evaluate(library, general.function.name, points.inputs, "float64")
    shared = {name: points.inputs[name] for name in ("t", "n", "v", "k_diffuse", "k_specular", "exponent")}
    lights = {name: np.asarray(points.inputs[name]) for name in points.inputs}
    expected = np.zeros((50, 3))
    for k in range(5):
        value = evaluate(library, "banks_shade", {**shared, "l": lights["light_directions"][:, k]}, "float64")
        expected += np.asarray(value) * lights["light_colours"][:, k]
    for k in range(6):
        offset = lights["light_positions_5"][:, k].astype(np.float64) - lights["position"]
        distance = np.linalg.norm(offset, axis=1)[:, None]
        value = evaluate(library, "banks_shade", {**shared, "l": offset / distance}, "float64")
        expected += np.asarray(value) * lights["light_colours_5"][:, k] / np.maximum(distance, 1.0) ** 2
    np.testing.assert_allclose(
        np.asarray(total), expected, rtol=tolerance("summed_lights"), atol=floor("summed_lights")
    )


def test_the_lights_of_a_map_bring_its_energy() -> None:
    generator = np.random.default_rng(5)
    rgb = generator.random((16, 32, 3)) ** 4
    rgb[3, 7] = (60.0, 50.0, 40.0)
    everything = environment.texels(rgb)
    for count in (1, 8, 32):
        lights = environment.median_cut(rgb, count)
        assert len(lights) == count
        np.testing.assert_allclose(
            np.sum([light.colour for light in lights], axis=0),
            everything.colours.sum(axis=0),
            rtol=tolerance("summed"),
        )
        np.testing.assert_allclose(
            [np.linalg.norm(light.direction) for light in lights], 1.0, rtol=tolerance("summed")
        )
    np.testing.assert_allclose(everything.colours.sum(axis=0), 4.0 * rgb_mean(rgb), rtol=tolerance("summed"))
    brightest = everything.directions.reshape(16, 32, 3)[3, 7]
    assert np.dot(lights[0].direction, brightest) > 0.999


def rgb_mean(rgb: environment.Floats) -> environment.Floats:
    """The mean over the sphere."""
    height = rgb.shape[0]
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    weights = (edges[:-1] - edges[1:]) / 2.0
    return np.asarray((rgb.mean(axis=1) * weights[:, None]).sum(axis=0))


MAPS = {
    "absent.exr": (None, 'cannot read "absent.exr"'),
    "broken.exr": (b"nothing", "cannot read"),
    "square.exr": (np.ones((4, 4, 3)), "is 4 x 4; a map in latitude and longitude is twice as wide as high"),
    "black.exr": (np.zeros((4, 8, 3)), "is black: no light comes from it"),
    "hole.exr": (np.full((4, 8, 3), np.nan), "32 pixels are no radiance, first row 0, column 0: R = nan"),
}


@pytest.mark.parametrize("name", MAPS)
def test_what_is_no_map_is_refused(tmp_path: Path, name: str) -> None:
    content, part = MAPS[name]
    if isinstance(content, bytes):
        (tmp_path / name).write_bytes(content)
    elif content is not None:
        (tmp_path / name).write_bytes(exr(content))
    scene = scene_of(tmp_path, f'[shade]\nmodel = "banks"\n[lights]\nenvironment = "{name}"\n')
    with pytest.raises(UserError) as caught:
        built(scene)
    sentence = str(caught.value)
    assert "[lights] environment: " in sentence
    assert part.replace("absent.exr", "").split('"')[0] in sentence


SMALL = """
[scene]
budget = 1e-3
[shade]
model = "kajiya_kay"
[parameters]
exponent = { min = 16.0, max = 32.0 }
"""


def written(folder: Path) -> Mapping[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_files_are_the_same_to_the_byte(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SMALL, encoding="utf-8")
    found = []
    for name in ("a", "b"):
        assert run(["scene", str(tmp_path / "small.toml"), "-o", str(tmp_path / name), "--no-drivers"]) == 0
        found.append(written(tmp_path / name))
    assert found[0] == found[1]
    assert sorted(found[0]) == [
        *("report.json", "report.md", "small_shade.cl", "small_shade.glsl", "small_shade.wgsl"),
    ]
    data = json.loads(found[0]["report.json"])
    assert [t["executed"] for t in data["targets"]] == [False, False, False]
    assert all(
        t["proof"]["holds"] and t["proof"]["points"] == build.UNEXECUTED_POINTS for t in data["targets"]
    )
    assert b"was not executed" in found[0]["report.md"]


REFUSED = {
    "model": (('"kajiya_kay"', '"kajia_kay"'), 'unknown model "kajia_kay"; did you mean "kajiya_kay"?'),
    "parameter": (("exponent = {", "exponnet = {"), 'did you mean "exponent"?'),
    "key": (("budget", "buget"), 'unknown key "buget"; did you mean "budget"?'),
    "target": (("[shade]", 'targets = ["glls"]\n[shade]'), 'unknown target "glls"; did you mean "glsl"?'),
    "range": (("min = 16.0", "min = 64.0"), "min = 64 is above max = 32"),
    "constant": (("{ min = 16.0, max = 32.0 }", "1e9"), "is outside its domain"),
    "budget": (("budget = 1e-3", "budget = 1e-12"), "no variant meets 1e-12; the best achievable is"),
    "view": (
        ("[parameters]", "[view]\nmin_t_dot_v = 0.5\nmax_t_dot_v = 0.25\n[parameters]"),
        "0.5 contradicts max_t_dot_v = 0.25",
    ),
    "map": (
        ("[parameters]", '[lights]\nenvironment = "absent.exr"\n[parameters]'),
        "environment: cannot read",
    ),
}


@pytest.mark.parametrize(("change", "part"), REFUSED.values(), ids=REFUSED)
def test_nothing_is_written_where_something_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: tuple[str, str], part: str
) -> None:
    (tmp_path / "small.toml").write_text(SMALL.replace(*change), encoding="utf-8")
    assert run(["scene", str(tmp_path / "small.toml"), "-o", str(tmp_path / "out"), "--no-drivers"]) == 2
    sentence = capsys.readouterr().err
    assert part in sentence
    assert sentence.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_failed_proof_names_the_term(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(tmp_path, SMALL.replace("[scene]", '[scene]\ntargets = ["wgsl"]'))
    monkeypatch.setattr(build, "PROOF_POINTS", 2000)
    monkeypatch.setattr(build, "SEARCH_POINTS", 2000)

    def failing(*arguments: Any) -> Proof:
        return replace(prove(*arguments), error=Measured(1.0, 1.0, 0, True))

    monkeypatch.setattr(build, "prove", failing)
    with pytest.raises(UserError, match=r"nothing is written: .* the last approximation was "):
        built(scene)
