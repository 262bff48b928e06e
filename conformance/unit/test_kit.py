"""A kit holds all that judging needs, and results that come back are judged or refused.

Plan. A small kit of functions of every kind of value is written once; the evaluator stands for a backend.
  kit       both files of vectors hold the same; intervals hold the reference; the stubs make the very
            programs that our own runtimes run; README.md names what is there
  judged    right results pass, in words, in numbers, in npz; wrong ones fail by their verdict: off by many
            ULP, NaN, a function without results, one that did not compile; JSON and JUnit as for our drivers
  refused   one sentence and status 2: missing lanes, missing rows, other functions, other versions, other
            inputs, unknown targets and tables, damage of every kind
  folder    other people's files are never replaced
The foreign runner in C++ computes a kit in test_foreign.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.execute import flatten, unflatten
from codegen.intervals import TABLES
from codegen.kernels import kernel
from codegen.kit.results import read_results
from codegen.kit.rows import hexadecimal, input_rows, result_rows
from codegen.library import load_library
from codegen.version import VERSION
from conformance.check.interval import excess
from conformance.check.merge import read
from targets.harness import complete_program

FUNCTIONS = ("sin_angle", "pcg3d", "strand_angles", "safe_pow")
"""A number, whole numbers, a struct, and a function of numbers alone."""
LANES = 16
FAR = 4000
"""ULP that a result is moved by: outside every interval and every bound of sin_angle."""
SEED = 20261122
DAMAGES = 300
Data = dict[str, Any]
Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def kit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("kit") / "kit"
    names = [part for name in FUNCTIONS for part in ("--function", name)]
    assert run(["kit", "-o", str(folder), "--lanes", str(LANES), *names]) == 0
    return folder


def load(path: Path) -> Any:
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def computed(kit: Path) -> Data:
    """Results of the evaluator in float32, as a runner writes them."""
    functions = {}
    for name in FUNCTIONS:
        vectors = load(kit / "vectors" / f"{name}.json")
        function = load_library().function(name)
        words = np.array([[int(w, 16) for w in row["words"]] for row in vectors["inputs"]], np.uint32)
        parts, first = {}, 0
        for p in function.parameters:
            count = sum(row.path.split(".")[0] == p.name for row in input_rows(function))
            parts[p.name] = unflatten(p.type, words[first : first + count])
            first += count
        rows = flatten([evaluate(load_library(), name, parts)], vectors["lanes"])
        functions[name] = {"vectors": vectors["vectors"], "rows": [hexadecimal(row) for row in rows]}
    about = load(kit / "kit.json")["kit"]
    return {"kit": about, "target": "opencl", "driver": "an engine", "functions": functions}


def judged(path: Path, data: Any, *options: str) -> int:
    path.write_text(json.dumps(data), encoding="utf-8")
    return run(["check", "--results", str(path), *options])


def copy(data: Data) -> Data:
    copied: Data = json.loads(json.dumps(data))
    return copied


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


def missing_lanes(data: Data) -> None:
    data["functions"]["sin_angle"]["rows"][0].pop()


def uneven_rows(data: Data) -> None:
    data["functions"]["pcg3d"]["rows"][1].pop()


def missing_row(data: Data) -> None:
    data["functions"]["strand_angles"]["rows"].pop()


def other_function(data: Data) -> None:
    data["functions"]["sin_angel"] = data["functions"].pop("sin_angle")


def other_version(data: Data) -> None:
    data["kit"]["version"] = "0.0.9"


def other_inputs(data: Data) -> None:
    data["functions"]["sin_angle"]["vectors"] = "0" * 16


def other_target(data: Data) -> None:
    data["target"] = "hlsl"


def other_table(data: Data) -> None:
    data["table"] = "vulcan"


def no_driver(data: Data) -> None:
    del data["driver"]


def no_kit(data: Data) -> None:
    del data["kit"]


def text_for_a_number(data: Data) -> None:
    data["functions"]["sin_angle"]["rows"][0][0] = "0.5f"


def list_for_a_number(data: Data) -> None:
    data["functions"]["sin_angle"]["rows"][0][0] = ["nan"]


def huge_kit(data: Data) -> None:
    data["kit"]["lanes"] = 10**12


def function_beside_the_kit(data: Data) -> None:
    data["kit"]["functions"].remove("pcg3d")


def kit_of_a_lost_function(data: Data) -> None:
    data["kit"]["functions"].append("strand_rim")


def nothing_at_all(data: Data) -> None:
    data["functions"] = {}


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (missing_lanes, " results, but its vectors have "),
        (uneven_rows, "the rows of pcg3d differ in length"),
        (missing_row, "strand_angles has 5 rows: cos_l, cos_v, sin_l, sin_v, defect"),
        (other_function, 'unknown function "sin_angel"; did you mean "sin_angle"?'),
        (other_version, f"made with a kit of vair 0.0.9, format 1; this is vair {VERSION}, format 1"),
        (other_inputs, "the results of sin_angle belong to vectors 0000000000000000 of another library"),
        (other_target, 'unknown target "hlsl"; did you mean "glsl"?'),
        (other_table, 'unknown accuracy table "vulcan"; did you mean "vulkan"?'),
        (no_driver, '"driver" is missing or no text'),
        (no_kit, 'holds no results: "kit" of kit.json is missing'),
        (text_for_a_number, 'row result holds "0.5f"; f32 is eight hexadecimal digits or a number'),
        (list_for_a_number, 'row result holds ["nan"]; f32 is eight hexadecimal digits or a number'),
        (function_beside_the_kit, "pcg3d is none of its kit's functions"),
        (kit_of_a_lost_function, 'unknown function "strand_rim"'),
        (huge_kit, '"kit": "lanes" is a number from 1 on'),
        (nothing_at_all, '"functions" holds no results'),
    ],
)
def test_what_cannot_be_judged_is_refused(
    change: Callable[[Data], None], told: str, computed: Data, tmp_path: Path, capsys: Capture
) -> None:
    data = copy(computed)
    change(data)
    assert judged(tmp_path / "r.json", data) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert told in err and err.startswith(f"vair: {tmp_path / 'r.json'}" if "table" not in told else "vair: ")


@pytest.mark.parametrize("end", ["json", "npz"])
def test_changed_bytes_never_end_in_a_traceback(end: str, computed: Data, tmp_path: Path) -> None:
    """Bytes at random places are changed, left out or doubled; what can still be read is read."""
    stream = np.random.default_rng(SEED)
    path = tmp_path / f"r.{end}"
    few = {"sin_angle": computed["functions"]["sin_angle"]}
    data = {**computed, "kit": {**computed["kit"], "functions": ["sin_angle"]}, "functions": few}
    if end == "npz":
        np.savez(path, about=np.array(json.dumps(data)), sin_angle=np.zeros((1, 3), np.float32))
    else:
        path.write_text(json.dumps(data), encoding="utf-8")
    whole, refused = path.read_bytes(), 0
    for _ in range(DAMAGES):
        place = int(stream.integers(len(whole)))
        new = [bytes([int(stream.integers(256))]), b"", whole[place : place + 9]][int(stream.integers(3))]
        path.write_bytes(whole[:place] + new + whole[place + 1 :])
        try:
            read_results(load_library(), path)
        except UserError as e:
            refused += 1
            assert str(e).startswith(str(path)) and "\n" not in str(e)
    assert refused > DAMAGES // 10


@pytest.mark.parametrize(
    "data", [b"", b"{", b"[]", b"PK\x03\x04", b'{"kit": 1}', b'{"kit": {}}', b"[" * 100_000]
)
def test_damaged_files_are_refused(data: bytes, tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "r.json"
    path.write_bytes(data)
    assert run(["check", "--results", str(path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


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


def test_other_folders_are_left_alone(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    assert run(["kit", "-o", str(tmp_path), "--function", "pcg3d"]) == 2
    assert "holds other files" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]
