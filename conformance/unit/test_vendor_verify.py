"""`vair verify` finds what drifted, and what an update changes in value.

Plan.
  files       clean, edited, missing, unexpected, stale, an update that stopped: state, exit status, JSON
  functions   removed, added, another signature, other fields, another bound; comments are no change
  values      both texts executed on a driver: the difference that a known edit makes, the same values from
              other code, results that are not finite, a text that the driver refuses, no driver
  layout      files of one function each, prefixes, scenes
A set of an older version is made of today's: texts and lock are changed alike.
"""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from codegen.backends import open_runtime
from codegen.emit.definition import read_definitions
from codegen.errors import UserError
from codegen.library import load_library
from codegen.vendor.changes import closure
from codegen.vendor.install import install
from codegen.vendor.lock import NAME, Lock, Promise, file_hash
from codegen.vendor.options import Options
from codegen.vendor.plan import Plan, plan_functions
from codegen.vendor.state import UNFINISHED
from conformance.unit.support.tolerances import tolerance
from conformance.unit.support.vendored import content, small_plan, vair

GLSL = Options(("glsl/430",), functions=("sin_angle", "fur_hair_area"))
SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "strand-bunny.toml"


@pytest.fixture(scope="module")
def glsl() -> Plan:
    return plan_functions(load_library(), GLSL)


def older(plan: Plan, text: Callable[[str], str], lock: Callable[[Lock], Lock] = lambda lock: lock) -> Plan:
    """The plan as another version had it."""
    files = {name: text(t) for name, t in plan.files.items()}
    hashes = {name: file_hash(t.encode()) for name, t in files.items()}
    return replace(plan, files=files, lock=lock(replace(plan.lock, version="0.0.9", files=hashes)))


def promised(lock: Lock, name: str, **changes: Any) -> Lock:
    """The lock with another promise of a function."""
    told = replace(lock.functions[name], **changes)
    return replace(lock, functions={**lock.functions, name: told})


def halved(text: str) -> str:
    """sin_angle with half of its values."""
    changed, count = re.subn(
        r"return 0\.5(f?) \* sqrt\(dot\(doubled", r"return 0.25\1 * sqrt(dot(doubled", text
    )
    assert count == 1
    return changed


def needs_driver(target: str = "glsl") -> None:
    try:
        open_runtime(target)
    except UserError as reason:
        pytest.skip(f"{target}: {reason}")


def verified(
    folder: Path, capsys: pytest.CaptureFixture[str], *options: str
) -> tuple[int, str, dict[str, Any]]:
    """Exit status, text and data."""
    data = folder.parent / "found.json"
    status, out, err = vair(capsys, "verify", folder, "--json", data, *options)
    assert err == ""
    return status, out, json.loads(data.read_text())


def test_every_state_of_a_file_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "v"
    plan = small_plan()
    install(folder, plan)
    status, out, data = verified(folder, capsys)
    assert (status, out) == (0, f"{folder}: as Vair {plan.lock.version} writes it\n")
    assert data["clean"] and data["files"] == [] == data["functions"]
    glsl = folder / "vair-430.glsl"
    glsl.write_text(glsl.read_text() + "// mine\n")
    (folder / "vair.wgsl").unlink()
    (folder / "notes").write_text("")
    (folder / UNFINISHED).mkdir()
    status, out, data = verified(folder, capsys, "--no-drivers")
    assert status == 1 and not data["clean"]
    found = {f["file"]: f["state"] for f in data["files"]}
    assert found == {
        "vair-430.glsl": "edited",
        "vair.wgsl": "missing",
        "notes": "unexpected",
        UNFINISHED: "unexpected",
    }
    assert data["functions"] == []
    assert "1 edited, 1 missing, 2 unexpected; no functions would change" in out
    assert "an update was interrupted; vair vendor finishes it" in out


def test_an_older_set_is_stale_and_a_comment_changes_no_function(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    install(tmp_path / "v", older(glsl, lambda text: text.replace("Directions are", "All directions are")))
    status, out, data = verified(tmp_path / "v", capsys)
    assert status == 1
    assert data["version"]["vendored"] == "0.0.9"
    assert data["files"] == [{"file": "vair-430.glsl", "state": "stale", "note": None}]
    assert data["functions"] == []
    assert f"Vair 0.0.9, now {glsl.lock.version}" in out


def test_values_are_compared_by_execution(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    needs_driver()
    install(tmp_path / "v", older(glsl, halved))
    status, out, data = verified(tmp_path / "v", capsys)
    assert status == 1
    (entry,) = data["functions"]
    assert (entry["function"], entry["kind"], entry["dialects"]) == ("sin_angle", "code", ["glsl/430"])
    found = entry["differences"]["glsl/430"]
    assert found["absolute"] == pytest.approx(0.5, abs=tolerance("halved"))  # the whole sine is 1 at most
    assert found["relative"] == 0.5
    assert found["points"] > 1000 and found["driver"]
    assert re.fullmatch(r"a=[0-9a-f ]{26};b=[0-9a-f ]{26}", found["at"])
    assert found["non_finite"] == {"old": 0, "new": 0}
    assert "sin_angle [glsl/430]: values differ by up to 0.5, relatively 0.5" in out


def test_other_code_with_the_same_values_says_so(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    needs_driver()
    swapped = older(glsl, lambda text: text.replace("vec3 s = a + b;", "vec3 s = b + a;"))
    install(tmp_path / "v", swapped)
    status, out, _ = verified(tmp_path / "v", capsys)
    assert status == 1
    assert "sin_angle [glsl/430]: other code, the same values" in out


def test_results_that_are_not_finite_are_counted(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    needs_driver()
    broken = older(
        glsl, lambda text: text.replace("return 0.5 * sqrt(", "return 1.0 / min(a.x, 0.0) + sqrt(")
    )
    install(tmp_path / "v", broken)
    _, out, data = verified(tmp_path / "v", capsys)
    found = data["functions"][0]["differences"]["glsl/430"]
    assert found["non_finite"]["old"] > 0 and found["non_finite"]["new"] == 0
    assert "not finite:" in out


def test_a_text_that_a_driver_refuses_is_said(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    needs_driver()
    install(
        tmp_path / "v",
        older(glsl, lambda text: text.replace("return 0.5 * sqrt(", "return unknown_name * (")),
    )
    status, _, data = verified(tmp_path / "v", capsys)
    sentence = data["functions"][0]["differences"]["glsl/430"]["not_executed"]
    assert status == 1
    assert "refuses the vendored text" in sentence and "unknown_name" in sentence


def test_a_definition_that_cannot_be_found_is_said(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    install(tmp_path / "v", glsl)
    file = tmp_path / "v" / "vair-430.glsl"
    file.write_text(file.read_text().replace("vair_sin_angle(", "my_sine("))
    _, _, data = verified(tmp_path / "v", capsys)
    assert "was not found" in data["functions"][0]["differences"]["glsl/430"]["not_executed"]


def test_without_a_driver_a_sentence_says_so(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    install(tmp_path / "v", older(glsl, halved))
    status, out, data = verified(tmp_path / "v", capsys, "--no-drivers")
    assert status == 1
    assert data["functions"][0]["differences"]["glsl/430"] == {"not_executed": "left out by --no-drivers"}
    assert "sin_angle [glsl/430]: left out by --no-drivers" in out


def test_promises_of_functions_are_compared(
    glsl: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def lock(old: Lock) -> Lock:
        old = promised(old, "sin_angle", errors=("relative <= 0.5: everywhere",))
        old = promised(old, "fur_hair_area", signature="fur_hair_area(hair_length: f32) -> f32")
        gone = {**old.functions, "gone": Promise("gone(x: f32) -> f32", (), "")}
        return replace(old, functions=gone, options=replace(old.options, functions=(*GLSL.functions, "gone")))

    install(tmp_path / "v", older(glsl, lambda text: text.replace("(radius_base + ", "(radius_tip + "), lock))
    status, out, data = verified(tmp_path / "v", capsys)
    assert status == 1
    kinds = {entry["function"]: entry["kind"] for entry in data["functions"]}
    assert kinds == {"sin_angle": "promise", "fur_hair_area": "signature", "gone": "removed"}
    assert data["functions"][-1]["old"]["errors"] == ["relative <= 0.5: everywhere"]
    assert (
        "fur_hair_area: fur_hair_area(hair_length: f32) -> f32 becomes fur_hair_area(hair_length: f32, "
        in out
    )
    assert "  gone: removed" in out
    assert "    error was  relative <= 0.5: everywhere" in out
    assert "    error now  relative <= 5e-7" in out


def test_functions_that_come_with_a_version_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A folder of all functions follows the library."""
    every = plan_functions(load_library(), Options(("wgsl/wgsl",)))
    known = {name: p for name, p in every.lock.functions.items() if name != "sin_angle"}
    install(tmp_path / "v", older(every, lambda text: text, lambda lock: replace(lock, functions=known)))
    status, out, _ = verified(tmp_path / "v", capsys, "--no-drivers")
    assert status == 1
    assert "  sin_angle: added" in out


def test_structs_with_other_fields_are_not_executed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = plan_functions(load_library(), Options(("glsl/430",), functions=("fur_average",)))
    name = next(iter(plan.lock.structs))
    old = older(
        plan,
        lambda text: re.sub(r"(struct \w+ \{\n)", r"\1    float more;\n", text, count=1),
        lambda lock: replace(lock, structs={**lock.structs, name: "more: f32"}),
    )
    install(tmp_path / "v", old)
    _, out, data = verified(tmp_path / "v", capsys)
    assert data["functions"][0]["kind"] == "structs"
    assert f"fields of {name} changed" in out


def test_files_of_one_function_each_and_prefixes_are_compared_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for target in ("wgsl", "opencl"):
        needs_driver(target)
        options = Options(
            (f"{target}/{'wgsl' if target == 'wgsl' else '1.2'}",), ("sin_angle",), "", "my_", True
        )
        plan = plan_functions(load_library(), options)
        own = older(plan, lambda text: halved(text) if "sin_angle(" in text else text)
        install(tmp_path / target, own)
        _, _, data = verified(tmp_path / target, capsys)
        assert next(iter(data["functions"][0]["differences"].values()))["relative"] == 0.5


def test_a_scene_is_vendored_and_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    needs_driver()
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "own.toml").write_text(SCENE.read_text())
    folder = tmp_path / "v"
    options = (
        "--scene",
        tmp_path / "scenes" / "own.toml",
        "--dialect",
        "es300",
        "--dialect",
        "430",
        "--no-drivers",
    )
    assert vair(capsys, "vendor", folder, *options, "--prefix", "fox_")[0] == 0
    assert set(content(folder)) == {"strand_bunny_shade-430.glsl", "strand_bunny_shade-es300.glsl", NAME}
    assert 'scene = "../scenes/own.toml"' in (folder / NAME).read_text()
    assert verified(folder, capsys)[0] == 0
    file = folder / "strand_bunny_shade-430.glsl"
    file.write_text(file.read_text().replace("    return ", "    return 0.5 * "))
    status, _, data = verified(folder, capsys)
    assert status == 1
    relative = data["functions"][0]["differences"]["glsl/430"]["relative"]
    assert relative == pytest.approx(0.5, rel=tolerance("halved"))
    (tmp_path / "scenes" / "own.toml").unlink()
    status, _, err = vair(capsys, "verify", folder)
    assert status == 2 and "own.toml: there is no such file" in err


def test_closure_holds_what_a_definition_needs_in_order() -> None:
    text = "struct S {\n    float x;\n};\nfloat b(S s) {\n    return s.x; // c\n}\n"
    text += "float c() {\n    return 1.0;\n}\nfloat a() {\n    return b(S(2.0));\n}\n"
    found = {d.name: d for d in read_definitions(text)}
    assert [code[0] for code in closure("a", found)] == ["struct S {", "float b(S s) {", "float a() {"]
    assert closure("z", found) == ()
