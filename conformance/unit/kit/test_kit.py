"""A kit holds all that judging needs, and results that come back are judged.

Plan. A small kit of functions of every kind of value is written once; the evaluator stands for a backend.
  kit       both files of vectors hold the same; intervals hold the reference; the stubs make the very
            programs that our own runtimes run; README.md names what is there
  judged    right results pass, in words, in numbers, in npz; wrong ones fail by their verdict: off by many
            ULP, NaN, a function without results, one that did not compile; JSON and JUnit as for our drivers
  folder    other people's files are never replaced
What cannot be judged: test_results. The foreign runner in C computes a kit in test_foreign.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.cli import run
from codegen.intervals import TABLES
from codegen.kernels import kernel
from codegen.kit.rows import input_rows, result_rows
from codegen.library import load_library
from conformance.check.interval import excess
from conformance.check.merge import read
from conformance.unit.kit.small_kit import FUNCTIONS, LANES, Data, copy, judged, load
from targets.harness import complete_program

FAR = 4000
"""ULP that a result is moved by: outside every interval and every bound of sin_angle."""
Capture = pytest.CaptureFixture[str]


def test_both_files_hold_the_same(kit: Path) -> None:
    for name in FUNCTIONS:
        data = load(kit / "vectors" / f"{name}.json")
        function, lanes = load_library().function(name), data["lanes"]
        with np.load(kit / "vectors" / f"{name}.npz", allow_pickle=False) as arrays:
            about = json.loads(str(arrays["about"][()]))
            assert {
                key: data[key] for key in ("function", "vectors", "source", "format")
            }.items() <= about.items()
            words = [[int(w, 16) for w in row["words"]] for row in data["inputs"]]
            assert arrays["inputs"].tolist() == words
            assert [row["path"] for row in data["inputs"]] == [row.path for row in input_rows(function)]
            assert arrays["expected"].tolist() == [row["values"] for row in data["expected"]]
            assert [row["path"] for row in data["expected"]] == [row.path for row in result_rows(function)]
            assert np.flatnonzero(arrays["ambiguous"]).tolist() == data["ambiguous"]
            for mask, bound in zip(arrays["bounds"], data["bounds"], strict=True):
                inside = list(range(lanes)) if bound["lanes"] == "all" else bound["lanes"]
                assert np.flatnonzero(mask).tolist() == inside
            for table in TABLES:
                ends = data["intervals"][table]
                ends = data["intervals"][ends] if isinstance(ends, str) else ends
                for end in ("low", "high"):
                    values = arrays[f"{table}_{end}"]
                    told = [[x if np.isfinite(x) else None for x in row] for row in values.tolist()]
                    assert told == [row["values"] for row in ends[end]]


def test_vectors_cover_random_points_and_hard_cases(kit: Path) -> None:
    data = load(kit / "vectors" / "sin_angle.json")
    families = {f["name"]: f["lanes"] for f in data["families"]}
    assert families["uniform"] == LANES
    assert "near_parallel" in families and "worst" in families
    assert sum(families.values()) == data["lanes"]


def test_intervals_are_those_that_judge(kit: Path) -> None:
    """At random points a table permits the rounded reference, and nothing far from it."""
    with np.load(kit / "vectors" / "sin_angle.npz") as arrays:
        low, high, expected = (arrays[key][0, :LANES] for key in ("opencl_low", "opencl_high", "expected"))
    nearest = expected.astype(np.float32)
    assert (excess(low, high, nearest) <= 1.0).all()
    assert (excess(low, high, nearest + np.float32(FAR) * np.spacing(nearest)) > 1.0).all()


@pytest.mark.parametrize("target", ["glsl", "wgsl", "opencl"])
def test_stubs_make_the_programs_that_we_run(kit: Path, target: str) -> None:
    library = load_library()
    harness = next((kit / target).glob("harness.*")).read_text(encoding="utf-8")
    assert harness == complete_program(target, "$library", "$body")
    call = next((kit / target / "calls").glob("strand_angles.*")).read_text(encoding="utf-8")
    assert call.rstrip("\n") in kernel(library, "strand_angles", target)
    text = next((kit / target).glob("library.*")).read_text(encoding="utf-8")
    assert all(f"vair_{name}(" in text for name in FUNCTIONS)


def test_the_description_names_what_is_there(kit: Path) -> None:
    text = (kit / "README.md").read_text(encoding="utf-8")
    data = load(kit / "vectors" / "sin_angle.json")
    named = (
        "kit.json",
        "harness.*",
        "library.*",
        *data,
        *data["intervals"],
        "load_f32(k)",
        "store_bool(k, value)",
    )
    assert not [word for word in named if word not in text and word not in ("format", "lanes", "families")]


def test_a_kit_is_the_same_twice(kit: Path, tmp_path: Path) -> None:
    again = tmp_path / "again"
    assert run(["kit", "-o", str(again), "--lanes", str(LANES), "--function", "pcg3d"]) == 0
    for end in ("json", "npz"):
        name = Path("vectors") / f"pcg3d.{end}"
        assert (again / name).read_bytes() == (kit / name).read_bytes()


def test_right_results_pass(computed: Data, tmp_path: Path, capsys: Capture) -> None:
    report, junit = tmp_path / "out.json", tmp_path / "out.xml"
    status = judged(tmp_path / "r.json", computed, "--json", str(report), "--junit", str(junit), "--details")
    told = capsys.readouterr().out
    assert status == 0, told
    assert "opencl of 4 functions: permitted 4, within bound 4, finite 4" in told
    assert "an engine" in told and "accuracy      relative" in told and "worst input" in told
    results = read(report)["results"]
    assert [(r["function"], r["driver"]) for r in results] == [(name, "an engine") for name in FUNCTIONS]
    assert results[0]["permitted"]["table"] == "opencl"
    assert junit.read_text(encoding="utf-8").count("<testcase") == 2 * len(FUNCTIONS)


def test_the_table_can_be_chosen(computed: Data, tmp_path: Path, capsys: Capture) -> None:
    assert judged(tmp_path / "r.json", computed, "--table", "vulkan", "--function", "sin_angle") == 0
    assert "the vulkan table permits" in capsys.readouterr().out
    assert judged(tmp_path / "r.json", {**computed, "table": "glsl"}, "--function", "sin_angle") == 0
    assert "the glsl table permits" in capsys.readouterr().out


def test_numbers_are_as_good_as_words(computed: Data, tmp_path: Path) -> None:
    data = copy(computed)
    rows = data["functions"]["sin_angle"]["rows"]
    words = np.array([[int(w, 16) for w in row] for row in rows], np.uint32)
    data["functions"]["sin_angle"]["rows"] = words.view(np.float32).astype(np.float64).tolist()
    whole = data["functions"]["pcg3d"]
    whole["rows"] = [[int(w, 16) for w in row] for row in whole["rows"]]
    assert judged(tmp_path / "r.json", data) == 0


def test_npz_is_as_good_as_json(computed: Data, tmp_path: Path) -> None:
    data = copy(computed)
    arrays: dict[str, Any] = {}
    for name, entry in data["functions"].items():
        words = np.array([[int(w, 16) for w in row] for row in entry.pop("rows")], np.uint32)
        arrays[name] = words if name != "sin_angle" else words[0].view(np.float32)
    path = tmp_path / "r.npz"
    np.savez(path, about=np.array(json.dumps(data)), **arrays)
    assert run(["check", "--results", str(path)]) == 0


def off(data: Data) -> None:
    row = data["functions"]["sin_angle"]["rows"][0]
    row[3] = f"{int(row[3], 16) + FAR:08x}"


def nan(data: Data) -> None:
    data["functions"]["sin_angle"]["rows"][0][5] = "nan"


def without_results(data: Data) -> None:
    del data["functions"]["pcg3d"]


def not_compiled(data: Data) -> None:
    data["functions"]["pcg3d"] = {"vectors": data["functions"]["pcg3d"]["vectors"], "failed": "error C1023"}


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            off,
            (
                "sin_angle on an engine: outside what opencl permits and outside its declared bound",
                "--replay",
            ),
        ),
        (nan, ("the result is not finite", "sin_angle/opencl/uniform/16/20260/5")),
        (without_results, ("FAILED    pcg3d on opencl: pcg3d has no results in r.json",)),
        (not_compiled, ("FAILED    pcg3d on opencl: pcg3d failed: error C1023",)),
    ],
)
def test_wrong_results_fail(
    change: Callable[[Data], None], told: tuple[str, ...], computed: Data, tmp_path: Path, capsys: Capture
) -> None:
    data = copy(computed)
    change(data)
    assert judged(tmp_path / "r.json", data) == 1
    out = capsys.readouterr().out
    assert [text for text in told if text not in out] == []


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["check", "--results", "none.json"], "none.json: No such file or directory"),
        (["check", "--table", "wgsl"], "--table needs --results"),
        (["check", "--results", "r.json", "--target", "glsl"], "leave out --target and --driver"),
        (["kit", "-o", "k", "--function", "env_radiance"], "env_radiance has no vectors"),
        (["kit", "-o", "k", "--target", "hlsl"], 'unknown target "hlsl"'),
    ],
)
def test_wrong_usage(
    arguments: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    assert told in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_files_of_others_are_left_alone(tmp_path: Path, capsys: Capture) -> None:
    """A kit replaces a kit, but no folder with anything else in it, whatever that is called."""
    folder = tmp_path / "kit"
    command = ["kit", "-o", str(folder), "--function", "pcg3d", "--lanes", "1"]
    assert run(command) == 0
    (folder / "kit.json").unlink()
    assert run(command) == 0
    assert (folder / "kit.json").is_file()
    (folder / "vectors" / "notes.txt").write_text("mine", encoding="utf-8")
    before = sorted(folder.rglob("*"))
    assert run(command) == 2
    assert "holds other files, as vectors/notes.txt" in capsys.readouterr().err
    assert sorted(folder.rglob("*")) == before
    assert [path.name for path in tmp_path.iterdir()] == ["kit"]
