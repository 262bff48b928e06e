"""A scene's report says what was dropped, substituted, saved and lost; lights of all three kinds in one file.

Plan. One scene with a directional light, a point light and a map, and ranges and constants, is built without
drivers. report.json and report.md are held against what they have to say; speeds, which need a driver, are
put in. A text that the compiler refuses does not keep it from counting another one.
"""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.cli import run
from codegen.library import default_root
from codegen.lines.linemap import Origin, read_map
from codegen.maps.image import exr
from codegen.scene.report.markdown import as_markdown
from codegen.scene.report.spirv import Counting, glslang

SCENE = """
[scene]
name = "three kinds"
budget = "half-step-8bit"
[shade]
model = "fakefur"
[parameters]
"coat.density" = 600.0
"coat.hair_length" = 0.5
"coat.radius_base" = 0.008
"coat.radius_tip" = 0.002
"optics.exponent" = { min = 16.0, max = 32.0 }
"optics.rho_transmit" = "optics.rho_reflect"
"optics.rho_surface" = 0.0
[view]
min_n_dot_v = 0.05
[lights]
directional = 1
point = 1
environment = "sky.exr"
environment_lights = 2
colour = { min = 0.0, max = 0.3 }
"""
ROOT = default_root().parent
SPEED = {"ns": 20.0, "low": 19.0, "high": 21.0, "build_seconds": 0.25}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("scene")
    (made / "scene.toml").write_text(SCENE, encoding="utf-8")
    (made / "sky.exr").write_bytes(exr(np.random.default_rng(3).random((8, 16, 3))))
    options = ["-o", str(made / "out"), "--map", str(made / "maps"), "--no-drivers"]
    assert run(["scene", str(made / "scene.toml"), *options]) == 0
    return made / "out"


@pytest.fixture(scope="module")
def data(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return found


def test_each_kind_of_light_has_only_the_inputs_it_needs(data: dict[str, Any], folder: Path) -> None:
    assert data["scene"]["lights"] == {
        "directional": 1,
        "point": 1,
        "environment": "sky.exr",
        "environment_lights": 2,
        "per_light": [],
    }
    left = [p["name"] for p in data["parameters"]["left"]]
    assert {"l_0", "light_0", "light_position_1", "light_1", "position"} <= set(left)
    assert not any(name.startswith("l_2") for name in left)  # the map's lights are constants of the text
    for target in data["targets"]:
        text = (folder / target["file"]).read_text(encoding="utf-8")
        assert all(name in text for name in left)


def test_it_says_what_went_and_why(data: dict[str, Any]) -> None:
    gone = set(data["parameters"]["gone"])
    assert {"density", "rho_transmit", "rho_surface", "cos_dark", "cos_lit"} <= gone
    assert data["exact_steps"]
    for step in data["exact_steps"]:
        assert all(step[key] for key in ("pass", "what", "why", "where")), step
    for target in data["targets"]:
        assert target["approximations"]
        for change in target["approximations"]:
            assert change["what"]
            assert change["why"]
            assert 0.0 < change["predicted_error"] <= data["scene"]["budget"]
        assert target["predicted"]["share_of_budget"] <= 1.0
        assert target["proof"]["error"]["largest"] <= data["scene"]["budget"]
        assert target["exact_proof"]["outside_intervals"] == 0


def test_it_counts_before_and_after(data: dict[str, Any]) -> None:
    for target in data["targets"]:
        counts = target["operations"]
        assert counts["general"]["all"] > counts["exact"]["all"] > counts["final"]["all"]
        assert target["lines"]["general"] > target["lines"]["final"] > 10
        spirv = target["spirv_instructions"]
        if target["target"] == "glsl" and glslang() is not None:
            assert min(spirv["general"], spirv["final"]) > 10  # general has one text for all lights
        else:
            assert spirv is None or set(spirv.values()) == {None}


@pytest.mark.skipif(glslang() is None, reason="glslang is not installed")
def test_a_text_that_is_refused_leaves_the_others_counted() -> None:
    good = "float vair_twice(float a) { return 2.0 * a; }", "vair_"
    (alone,) = Counting({"good": good}).results().values()
    assert alone is not None
    assert Counting({"bad": ("float vair_twice(", "vair_"), "good": good}).results() == {
        "bad": None,
        "good": alone,
    }


def test_lines_lead_to_the_library(
    data: dict[str, Any], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Statements of functions that were called lead there; those of the scene's own sum, to the scene."""
    for target in data["targets"]:
        found = read_map(folder.parent / "maps" / f"{target['file']}.json")
        told = {}
        for number, line in enumerate((folder / target["file"]).read_text().splitlines(), 1):
            if line and not line.startswith(("//", "#")):
                told[line] = found.origins[number]
        files = {origin.file for origin in told.values()}
        assert {"scene.toml", "shaderlib/fakefur/fakefur_shade.py"} <= files
        assert all(name == "scene.toml" or (ROOT / name).is_file() for name in files)
        kept = [(m[1], line) for line in told if (m := re.search(r"\b(square_[lv]|sin_[lv]) = ", line))]
        assert kept
        for name, line in kept:
            assert f"{name} = " in source_line(told[line]), line
    path = folder.parent / "maps" / f"{data['targets'][0]['file']}.json"
    number = next(k for k, origin in read_map(path).origins.items() if origin.file.endswith("shade.py"))
    assert run(["where", str(path), str(number)]) == 0
    assert capsys.readouterr().out.startswith("shaderlib/fakefur/fakefur_shade.py:")


def source_line(origin: Origin) -> str:
    return (ROOT / origin.file).read_text(encoding="utf-8").splitlines()[origin.line - 1]


def test_the_dearest_parameter_is_the_first(data: dict[str, Any]) -> None:
    costs = [row["operations_if_constant"] for row in data["remaining"]]
    assert costs == sorted(costs)
    assert costs[0] < data["targets"][0]["operations"]["final"]["all"]


def test_the_map_is_measured(data: dict[str, Any]) -> None:
    found = data["environment"]
    assert len(found["lights"]) == 2
    assert found["largest_error"] >= found["rms_error"] > 0.0


def test_the_page_says_it_too(data: dict[str, Any]) -> None:
    shown = copy.deepcopy(data)
    for target in shown["targets"]:
        target["speed"] = {"unit": "ns", "general": {**SPEED, "ns": 80.0}, "final": SPEED, "ratio": 0.25}
    text = as_markdown(shown)
    for target in shown["targets"]:
        for change in target["approximations"]:
            assert change["what"].replace("|", "\\|") in text
    assert f"The dearest parameter is `{data['remaining'][0]['parameter']}`" in text
    assert all(f"`{name}`" in text for name in data["parameters"]["gone"])
    gains = next(line for line in text.splitlines() if line.startswith("| glsl | "))
    assert "80" in gains
    assert "20" in gains
    assert "0.25" in gains


def test_a_narrowed_parameter_tells_its_own_interval_only(folder: Path) -> None:
    text = (folder / "three_kinds_shade.glsl").read_text(encoding="utf-8")
    (line,) = [x for x in text.splitlines() if "//   exponent" in x]
    assert line.count("in [") == 1
    assert line.endswith("in [16, 32]")
