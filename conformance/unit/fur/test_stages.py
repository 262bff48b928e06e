"""The stages that draw fur come from the library, and say what an engine has to know.

Plan.
  text      three models in every dialect pass glslang and naga; functions inside are the include's
  uniforms  offsets as glslang finds them in the GLSL
  states    the lecture's
  kit       the same twice, complete, its buffers and values where fur.json says
  helpers   tangents are derivatives of shell_offset, a fin ends on the outermost shell, shares scale coverage
  refused   models that need what no coat has; targets that draw no fur
"""

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from codegen.backends import dialect as find_dialect
from codegen.cli import run
from codegen.emit.module import emit_selection
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.fur.layout import FIN_VERTEX, FUR_VERTEX, uniform_block
from codegen.fur.shading import fixed_shading, fur_shading
from codegen.fur.stages import DIALECTS, stage_texts
from codegen.fur.states import pass_states
from codegen.library import load_library
from conformance.picture.tolerances import tolerance
from targets.packages import find_tool
from targets.protocol import TargetUnavailable
from targets.wgsl import validate as wgsl

ROOT = Path(__file__).parents[3]
SCENE = ROOT / "examples" / "scenes" / "furry-bunny.toml"
MODELS = ("fakefur_shade_slab", "shell_shade_printed", "scheuermann_shade")
LIBRARY = load_library()


def texts(model: str, target: str, dialect: str) -> dict[str, str]:
    return stage_texts(LIBRARY, fur_shading(LIBRARY, model), target, dialect)


@pytest.mark.parametrize("dialect", DIALECTS["glsl"])
@pytest.mark.parametrize("model", MODELS)
def test_glslang_accepts_the_stages(tmp_path: Path, model: str, dialect: str) -> None:
    glslang = find_tool("glslangValidator", "glslang")
    if glslang is None:
        pytest.skip("glslangValidator is not installed")
    found = texts(model, "glsl", dialect)
    assert sorted(found) == [f"{p}.{kind}" for p in ("base", "fin", "shell") for kind in ("frag", "vert")]
    for name, text in found.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    # Linked pass by pass, so that what one stage hands over is what the next one takes.
    for stage in ("base", "shell", "fin"):
        pair = [str(tmp_path / f"{stage}.vert"), str(tmp_path / f"{stage}.frag")]
        done = subprocess.run([glslang, "-l", *pair], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("model", MODELS)
def test_naga_accepts_the_module(model: str) -> None:
    try:
        wgsl.validate(texts(model, "wgsl", "wgsl")["fur.wgsl"])
    except TargetUnavailable as reason:
        pytest.skip(str(reason))


def test_the_functions_inside_are_the_librarys() -> None:
    text = texts("fakefur_shade", "glsl", "330")["shell.frag"]
    chosen = find_dialect("glsl", "330")
    expected = emit_selection(LIBRARY, chosen, LIBRARY.select(["shell_strand_mask"]), "vair_")
    assert "\n".join(expected) in text
    assert text.startswith("#version 330\n") and "SPDX-License-Identifier: MIT" in text
    assert "$" not in text


def test_members_lie_where_glslang_puts_them(tmp_path: Path) -> None:
    glslang = find_tool("glslangValidator", "glslang")
    if glslang is None:
        pytest.skip("glslangValidator is not installed")
    path = tmp_path / "base.frag"
    path.write_text(texts("fakefur_shade", "glsl", "330")["base.frag"], encoding="utf-8")
    done = subprocess.run([glslang, "-l", "-q", str(path)], capture_output=True, text=True, check=False)
    reported = dict(re.findall(r"^FurFrame\.(\w+)(?:\[0\])?: offset (\d+)", done.stdout, re.MULTILINE))
    shading = fur_shading(LIBRARY, "fakefur_shade")
    block = uniform_block((slot.name, slot.type) for slot in shading.material)
    ours = {member.name: str(member.offset) for member in block.members}
    # glslang lists what the stage uses; that is most of the block.
    used = {name: offset for name, offset in reported.items() if name in ours}
    assert len(used) > 15
    assert used == {name: ours[name] for name in used}
    size = re.search(r"^FurFrame: offset -1, type \w+, size (\d+)", done.stdout, re.MULTILINE)
    # A block ends on a multiple of 16 bytes, its last member may end before.
    assert size is not None and 0 <= block.size - int(size.group(1)) < 16


def test_the_block_packs_what_it_is_given() -> None:
    shading = fur_shading(LIBRARY, "shell_shade")
    block = uniform_block((slot.name, slot.type) for slot in shading.material)
    values: dict[str, Any] = {m.name: np.zeros(m.components) for m in block.members}
    values |= {"seed": 2**32 - 1, "light_colour": [[1, 2, 3, 0], [4, 5, 6, 0]], "shade_p_specular": 24.0}
    data = block.pack(values)
    at = {member.name: member for member in block.members}
    assert len(data) == block.size and block.size % 16 == 0
    assert data[at["seed"].offset :][:4] == b"\xff" * 4
    assert np.frombuffer(data[at["light_colour"].offset :][16:28], "<f4").tolist() == [4.0, 5.0, 6.0]
    assert np.frombuffer(data[at["shade_p_specular"].offset :][:4], "<f4").tolist() == [24.0]
    with pytest.raises(ValueError, match="light_colour holds 8 values, not 9"):
        block.pack({**values, "light_colour": np.zeros((9, 4))})


def test_pass_states_are_the_lectures() -> None:
    states = pass_states(closed=True)
    assert list(states) == ["base", "shell", "fin"]
    assert all(state["depth_test"] == "less-equal" for state in states.values())
    assert [bool(state["blend"]) for state in states.values()] == [False, True, True]
    assert [state["depth_write"] for state in states.values()] == [True, False, False]
    assert [state["cull"] for state in states.values()] == ["back", "back", "none"]
    assert pass_states(closed=False)["shell"]["cull"] == "none"


@pytest.fixture(scope="module")
def kits(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, bytes]]:
    folder = tmp_path_factory.mktemp("kit")
    scene = SCENE.read_text(encoding="utf-8").replace("subdivide = 1", "subdivide = 0")
    scene = scene.replace("../data/bunny.obj", "ball.ply")
    trimesh.creation.icosphere(subdivisions=2).export(folder / "ball.ply")
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    written = []
    for name in ("first", "second"):
        assert run(["fur", str(folder / "scene.toml"), "-o", str(folder / name)]) == 0
        written.append({path.name: path.read_bytes() for path in (folder / name).iterdir()})
    return written


def test_the_kit_is_the_same_twice(kits: list[dict[str, bytes]]) -> None:
    assert kits[0] == kits[1]
    assert len(kits[0]) == 6 * 2 + 3  # stages in two dialects of GLSL; fur.wgsl, fur.bin, fur.json


def test_the_kit_says_where_everything_lies(kits: list[dict[str, bytes]]) -> None:
    kit = kits[0]
    about = json.loads(kit["fur.json"])
    assert [p["name"] for p in about["passes"]] == ["base", "shell", "fin"]
    assert [p["instances"] for p in about["passes"]] == [1, 31, 1]
    for p in about["passes"]:
        assert all(name in kit for pair in p["glsl"].values() for name in pair)
        for entry in ("vertex", "fragment"):
            assert f"fn {p['wgsl'][entry]}(" in kit[p["wgsl"]["file"]].decode()
    buffers, data = about["buffers"], kit["fur.bin"]
    fins = np.frombuffer(
        data, FIN_VERTEX, buffers["fin_vertices"]["count"], buffers["fin_vertices"]["offset"]
    )
    assert buffers["fin_vertices"]["stride"] == FIN_VERTEX.itemsize and set(fins["w"]) == {0.0, 1.0}
    triangles = np.frombuffer(data, "<u4", buffers["triangles"]["count"], buffers["triangles"]["offset"])
    assert triangles.size == 3 * about["mesh"]["triangles"]
    assert triangles.max() == buffers["vertices"]["count"] - 1
    assert [a["name"] for a in buffers["vertices"]["attributes"]] == list(FUR_VERTEX.names or ())
    assert sum(b["bytes"] for b in buffers.values() if isinstance(b, dict)) == len(data)
    members = {m["name"]: m for m in about["uniforms"]["members"]}
    assert members["layers"]["value"] == 32 and members["shade_skin"]["value"] == [0.2, 0.12, 0.1]
    assert about["mesh"]["border edges"] == 0


def bends(count: int) -> dict[str, Any]:
    rng = np.random.default_rng(2010)
    n = rng.normal(size=(count, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return {"n": n, "comb": rng.uniform(-0.4, 0.4, (count, 3)), "force": rng.uniform(-0.4, 0.4, (count, 3))}


def test_tangents_are_derivatives_of_the_offset() -> None:
    inputs = bends(500)
    height = np.random.default_rng(16).uniform(0.05, 0.95, 500)
    zero = {"position": np.zeros((500, 3)), "coat_length": np.ones(500)}
    step = 1e-5
    ends = [
        np.asarray(evaluate(LIBRARY, "shell_offset", {**inputs, **zero, "height": height + d}, "float64"))
        for d in (-step, step)
    ]
    expected = (ends[1] - ends[0]) / (2.0 * step)
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    tangent = evaluate(LIBRARY, "shell_tangent", {**inputs, "height": height}, "float64")
    assert np.abs(tangent - expected).max() < tolerance("fur_tangent")
    root = evaluate(LIBRARY, "shell_tangent", {**inputs, "height": np.zeros(500)}, "float64")
    assert np.abs(root - inputs["n"]).max() < tolerance("fur_tangent")


def test_a_fin_ends_on_the_outermost_shell() -> None:
    inputs = bends(500)
    place = {"position": np.ones((500, 3)), "coat_length": np.full(500, 0.7)}
    outermost = {**inputs, **place, "height": np.ones(500)}
    top = np.asarray(evaluate(LIBRARY, "shell_offset", outermost, "float64"))
    direction = evaluate(LIBRARY, "fin_direction", inputs, "float64")
    fin = {**place, "n": direction, "w": np.ones(500)}
    tip = np.asarray(evaluate(LIBRARY, "fin_position", fin, "float64"))
    assert np.abs(tip - top).max() < tolerance("fur_tangent")


def test_coverage_is_proportional_to_the_share() -> None:
    rng = np.random.default_rng(3)
    count = 200_000
    given = {
        "uv": rng.uniform(0.0, 4.0, (count, 2)),
        "height": np.full(count, 0.25),
        "density": np.full(count, 64.0),
        "seed": np.full(count, 5, np.uint32),
    }

    def coverage(share: float) -> float:
        inputs = {"thickness": np.full(count, 0.8), "share": np.full(count, share)}
        thickness = evaluate(LIBRARY, "thinned", inputs, "float32")
        mask = evaluate(LIBRARY, "shell_strand_mask", {**given, "thickness": thickness}, "float32")
        return float(np.mean(np.asarray(mask)))

    full = coverage(1.0)
    assert full > 0.1 and coverage(0.0) == 0.0
    assert abs(coverage(0.5) / full - 0.5) < tolerance("fur_coverage")


@pytest.mark.parametrize(
    ("model", "sentence"),
    [
        ("brushed_shade", 'brushed_shade cannot shade fur: a coat has no "map_tangent"'),
        ("fur_opacity", "fur_opacity cannot shade fur: it returns no colour"),
        ("fakefur_shad", 'unknown function "fakefur_shad"; did you mean "fakefur_shade"'),
    ],
)
def test_models_that_no_coat_can_feed_are_refused(model: str, sentence: str) -> None:
    with pytest.raises(UserError, match=re.escape(sentence)):
        fur_shading(LIBRARY, model)


def test_folded_parameters_leave_no_uniforms() -> None:
    shading = fur_shading(LIBRARY, "shell_shade")
    material = {
        "k_diffuse": (0.3, 0.2, 0.1),
        "p_diffuse": 1.0,
        "k_specular": (0.1, 0.1, 0.1),
        "p_specular": 8.0,
    }
    library, fixed = fixed_shading(LIBRARY, shading, material, painted=True)
    assert fixed.material == () and [p.name for p in fixed.function.parameters] == ["n", "l", "h"]
    for target, dialects in DIALECTS.items():
        for text in stage_texts(library, fixed, target, dialects[0]).values():
            assert re.search(r"\bshade_", text) is None  # how members of the material are called


def test_a_target_that_draws_no_fur_says_so() -> None:
    with pytest.raises(UserError, match="target opencl draws no fur; glsl and wgsl do"):
        texts("shell_shade", "opencl", "1.2")
