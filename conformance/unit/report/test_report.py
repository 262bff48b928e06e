"""The report: data, fronts, page, picture, command. No test asserts a speed; the figures are made up.

Plan.
  fronts        of random points no member is dominated, and every other point is by a member
  data          report.json is whole, is read again, what is none is refused; names of variants are short
  records       worst inputs are replayed by `vair check --replay`; peers' forms stand beside ours
  page          every function, driver and command is in it; nothing comes from the network; data cannot end
                its script element
  picture       a PNG, the same bytes for the same figures
  writing       all files or none; records of an earlier report go
  scenes        what vair scene wrote becomes a table
  command       bad functions, targets, drivers, folders and combinations are refused with one sentence
Not covered here: what the page does in a browser (test_page.py), measuring (../bench/test_bench.py).
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from codegen import costs
from codegen.errors import UserError
from codegen.library import Library, load_library
from conformance.check.replay import cases_of
from conformance.commands.report import command
from conformance.report import worst
from conformance.report.model import build, read_report
from conformance.report.page import embedded, number, page
from conformance.report.pareto import dominates, front
from conformance.report.picture import overview
from conformance.report.scenes import read_scene_report
from conformance.report.view import short_name, view
from conformance.report.write import keep, write
from conformance.unit.support.results import MESA, POCL, small_result

SEED = 20_264


@pytest.fixture(scope="module")
def library() -> Library:
    return load_library()


@pytest.fixture(scope="module")
def report(library: Library) -> dict[str, Any]:
    results = [small_result(library, device) for device in (MESA, POCL)]
    return build(library, results, command="vair report -o DIR", skipped={"wgsl": "no driver"})


@pytest.fixture(scope="module")
def written(library: Library, report: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the report."""
    folder = tmp_path_factory.mktemp("report")
    write(library, report, folder)
    return folder


def test_fronts_of_random_points() -> None:
    rng = np.random.default_rng(SEED)
    for _ in range(50):
        points = {f"p{k}": (float(x), float(y)) for k, (x, y) in enumerate(rng.integers(0, 9, (20, 2)))}
        found = front(points)
        assert found == sorted(found, key=lambda name: (points[name], name))
        for name, p in points.items():
            beaten = any(dominates(points[other], p) for other in found)
            assert beaten != (name in found), f"{name} of {points}"


def test_fronts_of_a_report(report: dict[str, Any]) -> None:
    chosen = next(f for f in report["fronts"] if f["function"] == "sin_angle" and f["unit"] == "ulp")
    assert chosen["members"] == ["sin_angle_cosine", "sin_angle_cross", "sin_angle_half", "sin_angle"]
    printed = [m for f in report["fronts"] for m in f["members"] if m.endswith("_printed")]
    assert not printed, "a printed form computes something else"


def test_a_report_is_read_again(report: dict[str, Any], written: Path) -> None:
    assert read_report(written) == report
    assert read_report(written / "report.json")["drivers"][0]["groups"][0]["modes"]["latency"]["raw_ns"]


@pytest.mark.parametrize(
    "text", ["", "[]", '{"schema": 0}', '{"schema": 1}', '{"schema": 1, "drivers": [{}]}']
)
def test_what_is_no_report_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "report.json").write_text(text, encoding="utf-8")
    with pytest.raises(UserError, match=r"report\.json"):
        read_report(tmp_path)


@pytest.mark.parametrize(
    ("name", "base", "short"),
    [
        ("strand_specular_sq16", "strand_specular", "sq16"),
        ("fakefur_shade_slab_rational_sq16", "fakefur_shade", "slab rational sq16"),
        ("strand_cosine", "strand_cosine", "default"),
        ("peer_sine_unclamped", "sin_angle", "sine unclamped"),
    ],
)
def test_short_names(name: str, base: str, short: str) -> None:
    assert short_name(name, base) == short


def test_worst_inputs_can_be_replayed(library: Library, report: dict[str, Any], written: Path) -> None:
    place = written / worst.place(report["drivers"][0], "sin_angle")
    (case,) = cases_of(library, str(place))  # one input is the worst in both units
    assert (case.function, case.target) == ("sin_angle", "glsl")
    assert np.array_equal(case.draw().inputs["a"], [[1.0, 0.0, 0.0]])


def test_a_peers_form_stands_beside_ours(library: Library, report: dict[str, Any]) -> None:
    """It is drawn, measured again by our function's name, never on a front, and no function to replay."""
    result = json.loads(json.dumps(report["drivers"][0]))
    entry = next(f for f in result["functions"] if f["name"] == "sin_angle_cosine")
    entry |= {"name": "peer_sine_unclamped", "kind": "peer"}
    made = build(library, [result], command="")
    assert not any("peer_sine_unclamped" in f["members"] for f in made["fronts"])
    assert not worst.records(result, entry)
    group = next(g for g in view(library, made)["groups"] if g["name"] == "sin_angle")
    shown = next(e for e in group["entries"] if e["kind"] == "peer")
    assert (shown["tag"], shown["replay"], shown["front"]) == ("sine unclamped", "", [])
    assert shown["again"].endswith("--function sin_angle --target glsl")


def test_the_page_is_whole(report: dict[str, Any], written: Path) -> None:
    text = (written / "report.html").read_text(encoding="utf-8")
    for result in report["drivers"]:
        for f in result["functions"]:
            assert f">{f['name']}</a>" in text
            assert str(worst.place(result, f["name"])) in text
    assert "Mesa 22.3.6" in text and "no driver" in text and report["date"][:10] in text
    own = re.sub(r"<script.*?</script>|<style.*?</style>", "", text, flags=re.DOTALL)
    assert not re.findall(r"(?:src|href)=\"(?!#|data:)[^\"]*", own), "the page asks for another file"


def test_data_cannot_end_their_script() -> None:
    assert "</" not in embedded({"a": "</script><script>"})
    assert json.loads(embedded({"a": "</b>"})) == {"a": "</b>"}
    with pytest.raises(ValueError):
        embedded({"a": float("nan")})


def test_names_in_a_page_are_escaped(library: Library, report: dict[str, Any]) -> None:
    assert "<b>bold" not in page(library, {**report, "command": "vair <b>bold"})


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "\u2013"),
        (0.0, "0"),
        (0.8713, "0.871"),
        (12.345, "12.3"),
        (1540.2, "1,540"),
        (2.64e-7, "2.6e-7"),
    ],
)
def test_numbers_for_people(value: float | None, text: str) -> None:
    assert number(value) == text


def test_the_picture_depends_on_the_figures_alone(report: dict[str, Any], written: Path) -> None:
    picture = (written / "overview.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    assert picture == overview({**report, "date": "another"})


def test_writing_replaces_an_earlier_report(library: Library, report: dict[str, Any], tmp_path: Path) -> None:
    stale = tmp_path / "worst" / "glsl-llvmpipe" / "gone.json"
    stale.parent.mkdir(parents=True)
    stale.write_text("{}", encoding="utf-8")
    write(library, report, tmp_path)
    assert not stale.exists()
    assert {p.name for p in tmp_path.iterdir()} == {"report.html", "report.json", "overview.png", "worst"}


def test_kept_results_are_without_single_rounds(report: dict[str, Any], tmp_path: Path) -> None:
    names = {path.name for path in keep(report["drivers"], b"picture", tmp_path)}
    assert names == {"glsl-llvmpipe.json", "opencl-pocl.json"}
    assert "raw_ns" not in (tmp_path / "glsl-llvmpipe.json").read_text(encoding="utf-8")
    assert (tmp_path / "overview.png").read_bytes() == b"picture"


def test_scenes_become_tables(tmp_path: Path) -> None:
    speed = {"general": {"ns": 8.0}, "final": {"ns": 2.0}, "unit": "ns", "ratio": 0.25}
    target = {
        "target": "glsl",
        "driver": "llvmpipe (LLVM 15.0.6, 256 bits); Mesa 22.3.6; OpenGL 4.5",
        "executed": True,
        "operations": {"general": {"all": 228}, "exact": {"all": 150}, "final": {"all": 96}},
        "lines": {"general": 90, "final": 40},
        "spirv_instructions": None,
        "speed": speed,
        "proof": {"error": {"half_steps_8bit": 0.25}},
        "predicted": {"half_steps_8bit": 0.3},
    }
    scene = {"name": "fox", "model": "fakefur_shade", "budget_stated": "half-step-8bit"}
    data = {
        "schema": 1,
        "scene": scene,
        "parameters": {"before": ["t", "n"], "left": ["t"]},
        "targets": [target],
    }
    (tmp_path / "report.json").write_text(json.dumps(data), encoding="utf-8")
    found = read_scene_report(tmp_path)
    assert found["name"] == "fox"
    assert found["rows"] == [
        ["glsl", "llvmpipe", "228 \u2192 96", "90 \u2192 40", "\u2013", "8 \u2192 2", "0.25", "0.25", "0.3"]
    ]
    assert len(found["rows"][0]) == len(found["columns"])
    with pytest.raises(UserError, match="vair scene"):
        read_scene_report(tmp_path / "nothing")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--function", "sin_angel"], 'did you mean "sin_angle"'),
        (["--target", "glls"], 'did you mean "glsl"'),
        (["--driver", "lavapip"], 'did you mean "lavapipe"'),
        (["--driver", "softpipe-compute"], "cannot be timed"),
        (["--record", "--quick"], "--record keeps whole measurements"),
        (["--from-recorded", "--quick"], "--from-recorded measures nothing"),
        (["--scene", "nowhere"], "vair scene"),
        (["--against", "nowhere"], "report.json"),
    ],
)
def test_bad_usage_is_one_sentence(arguments: list[str], words: str, tmp_path: Path) -> None:
    answer = CliRunner().invoke(command, ["-o", str(tmp_path / "out"), *arguments])
    assert isinstance(answer.exception, UserError)
    assert words in str(answer.exception)
    assert not (tmp_path / "out" / "report.html").exists()


def test_a_folder_that_cannot_be_written_to(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    answer = CliRunner().invoke(command, ["-o", str(tmp_path / "file"), "--from-recorded"])
    assert isinstance(answer.exception, UserError)
    assert "cannot write the report into" in str(answer.exception)


def test_from_recorded(
    library: Library, report: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(costs, "results_folder", lambda: tmp_path)
    costs.recorded.cache_clear()
    arguments = ["-o", str(tmp_path / "out"), "--from-recorded"]
    answer = CliRunner().invoke(command, arguments)
    assert isinstance(answer.exception, UserError) and "nothing is recorded" in str(answer.exception)
    keep(report["drivers"], b"", tmp_path)
    costs.recorded.cache_clear()
    answer = CliRunner().invoke(command, [*arguments, "--function", "sin_angle_half", "--target", "glsl"])
    costs.recorded.cache_clear()
    assert answer.exception is None, answer.output
    made = read_report(tmp_path / "out")
    assert made["recorded"]
    assert {f["base"] for r in made["drivers"] for f in r["functions"]} == {"sin_angle"}
    assert [r["device"]["target"] for r in made["drivers"]] == ["glsl"]
