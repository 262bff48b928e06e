"""What the page of `vair demo web` is made of: its files, what it offers and the figures that it shows.

Plan.
  files     every file that a kit names is there; every parameter sets something; one mesh serves all variants
  choices   ranges lie inside the declared domains and inside those of the recorded errors; a variant reads
            every parameter but those that it is said not to read
  figures   no time stands without error, driver, domain and method; they are the recorded ones
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.costs import recorded
from codegen.evaluate import evaluate
from codegen.fur.shading import FROM_STAGE, fur_shading
from codegen.ir.types import Struct
from codegen.library import Library, load_library
from conformance.web.choices import Shading, choices
from conformance.web.figures import BACKENDS, figures, misprint, records

SEED = 20261122
PLACES = 200


@pytest.fixture(scope="module")
def library() -> Library:
    return load_library()


# ---------------------------------------------------------------- files


def test_every_file_that_a_kit_names_is_there(files: dict[str, bytes]) -> None:
    plan = json.loads(files["web.json"])
    assert [entry["name"] for entry in plan["shadings"]]
    for entry in plan["shadings"]:
        about = json.loads(files[entry["kit"]])
        folder = entry["kit"].rpartition("/")[0]
        assert about["shading"]["function"] == entry["name"]
        assert about["buffers"]["file"] == "../../fur.bin"
        named = {about["passes"][0]["wgsl"]["file"]}
        for item in about["passes"]:
            named |= set(item["glsl"]["es300"])
            assert list(item["glsl"]) == ["es300"], "a browser needs no desktop stages"
        assert {f"{folder}/{name}" for name in named} <= files.keys()
        members = {member["name"] for member in about["uniforms"]["members"]}
        for parameter in plan["parameters"]:
            for path in parameter["sets"]:
                assert about["shading"]["material"].get(path, path) in members
    assert re.findall(rb'(?:src|href)="(\w+\.[^"]*)"', files["index.html"]) == [b"page.css", b"page.js"]


def test_modules_import_what_is_there(files: dict[str, bytes]) -> None:
    modules = [name for name in files if name.endswith(".js")]
    for name in modules:
        for found in re.findall(r'from "\./([^"]+)"', files[name].decode()):
            assert found in modules
    assert not [name for name in modules if re.search(rb"https?://", files[name])], "no network is needed"


# ---------------------------------------------------------------- choices


def domains(library: Library, name: str) -> dict[str, Any]:
    """Declared domain by path."""
    found: dict[str, Any] = {}
    for parameter in library.function(name).parameters:
        if isinstance(parameter.type, Struct):
            found |= {f"{parameter.name}.{f.name}": f.domain for f in parameter.type.fields}
        else:
            found[parameter.name] = parameter.domain
    return found


def test_ranges_lie_inside_every_domain(library: Library) -> None:
    stated: dict[str, list[tuple[float, float]]] = {}
    for shading in choices().shadings:
        for found in figures(library, shading).values():
            for path, low, high in re.findall(r"([\w.]+) in \[([^,]+), ([^]]+)\]", found["error"]["domain"]):
                stated.setdefault(path, []).append((float(low), float(high)))
        declared = domains(library, shading.name)
        for parameter in choices().parameters:
            for path in parameter.sets:
                if path in declared:
                    stated.setdefault(path, []).append((declared[path].low, declared[path].high))
    assert {"optics.exponent", "optics.cos_dark", "optics.cos_lit", "coat.density"} <= stated.keys()
    for parameter in choices().parameters:
        for path in parameter.sets:
            for low, high in stated.get(path, []):
                assert low <= parameter.least < parameter.most <= high, path


def test_every_material_parameter_has_a_control(library: Library) -> None:
    offered = {path for parameter in choices().parameters for path in parameter.sets}
    for shading in choices().shadings:
        assert {slot.path for slot in fur_shading(library, shading.name).material} <= offered


def drawn_inputs(library: Library, name: str) -> dict[str, Any]:
    """Random inputs within the controls' ranges, directions on the lit and seen side, by parameter."""
    rng = np.random.default_rng(SEED)
    controls = {path: p for p in choices().parameters for path in p.sets}

    def row(path: str, size: int) -> Any:
        if path in FROM_STAGE:
            v = rng.normal(size=(PLACES, 3))
            v[:, 2] = np.abs(v[:, 2]) + 0.1
            return np.ones((PLACES, 3)) if path == "light" else v / np.linalg.norm(v, axis=1, keepdims=True)
        values = rng.uniform(controls[path].least, controls[path].most, (PLACES, size))
        return values if size > 1 else values[:, 0]

    inputs: dict[str, Any] = {}
    for parameter in library.function(name).parameters:
        if isinstance(parameter.type, Struct):
            parts = {
                f.name: row(f"{parameter.name}.{f.name}", getattr(f.type, "size", 1))
                for f in parameter.type.fields
            }
            inputs[parameter.name] = parts
        else:
            inputs[parameter.name] = row(parameter.name, getattr(parameter.type, "size", 1))
    return inputs


def shaded(library: Library, name: str, inputs: dict[str, Any]) -> Any:
    return evaluate(library, name, inputs, "float64")


@pytest.mark.parametrize("shading", choices().shadings, ids=lambda shading: shading.name)
def test_a_variant_reads_what_it_is_said_to_read(library: Library, shading: Shading) -> None:
    print(f"seed {SEED}")
    inputs = drawn_inputs(library, shading.name)
    before = shaded(library, shading.name, inputs)
    for path in (path for p in choices().parameters for path in p.sets if path.startswith("optics.")):
        changed = {key: dict(x) if isinstance(x, dict) else x for key, x in inputs.items()}
        changed["optics"][path.partition(".")[2]] = 0.5 * changed["optics"][path.partition(".")[2]] + 0.01
        same = np.array_equal(shaded(library, shading.name, changed), before)
        assert same == (path in shading.unused), path


# ---------------------------------------------------------------- figures


def test_no_time_stands_without_error_driver_domain_and_method(library: Library) -> None:
    for shading in choices().shadings:
        found = figures(library, shading)
        assert found.keys() == BACKENDS.keys() == records().keys()
        for backend, figure in found.items():
            assert figure["net_ns"] > 0.0
            assert figure["error"]["max"] > 0.0
            assert figure["error"]["domain"]
            assert all(
                records()[backend][key] for key in ("driver", "device", "cpu", "clock", "order", "net")
            )


def test_figures_are_the_recorded_ones(library: Library) -> None:
    glsl = next(r for r in recorded() if r["device"]["target"] == "glsl")
    name = choices().shadings[2].name
    kept = next(f for f in glsl["functions"] if f["name"] == name)
    shown = figures(library, choices().shadings[2])["webgl2"]
    assert shown["ratio"] == kept["speed"]["throughput"]["ratio"]
    assert shown["error"]["max"] == kept["error"]["max"]


def test_the_misprint_is_that_of_the_table() -> None:
    table = Path(__file__).parents[2] / "printed" / "README.md"
    row = next(
        line for line in table.read_text(encoding="utf-8").splitlines() if "fakefur_shade_printed" in line
    )
    light = misprint(choices())["every_light"]
    assert row.endswith(f"{light['largest']:.3g}, {light['mean']:.3g} |")
