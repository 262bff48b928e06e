"""Recorded results: what is kept of a run, and the page made of it.

Plan.
  record  one line per function, worst inputs as words, other modes of a file stay; what is kept of an
          interrupted run, and what a resumed one repeats
  page    counts, shares, known and unknown failures; the committed page is what the committed files give
"""

from __future__ import annotations

import datetime
import json
from pathlib import Path

import pytest

from codegen.library import load_library
from conformance.check.accuracy import Accuracy
from conformance.check.interval import IntervalResult
from conformance.check.result import BoundResult, FunctionResult
from conformance.drivers import record
from conformance.drivers.matrix import page
from conformance.drivers.modes import modes
from conformance.drivers.record import FOLDER, Recorder, hex_words, read_all, stale
from targets import Device
from targets.drivers import catalogue, driver

DEVICE = Device("opencl", "OpenCL 3.0", "Portable Computing Language 3.1+debian", "pthread")
DAY = datetime.date(2026, 6, 1)
BOUND = 1e-6
"""The declared bound of the results made up here."""


def result(name: str, measured: float, stage: str = "judged") -> FunctionResult:
    r = FunctionResult(name, "opencl", "a driver", lanes=10, backend="pocl+default", stage=stage)
    r.bounds = [BoundResult("b", BOUND, measured, worst="a = 1 [3f800000]", failures=int(measured > BOUND))]
    r.permitted = IntervalResult("opencl", 8, 8, unguaranteed=2)
    r.accuracy = [
        Accuracy("relative", 1.5e-4, 10, measured, measured / 2.0, measured / 4.0, "a = 1 [3f800000]"),
        Accuracy("8-bit steps", 0.0, 10, 0.25, 0.125, 0.0, "a = 2 [40000000]"),
    ]
    if stage != "judged":
        r.broken = "does not compile: line 3"
    return r


def recorder(folder: Path, mode: str) -> Recorder:
    return Recorder(load_library(), driver("pocl"), DEVICE, modes()[mode], DAY, folder)


def kept(folder: Path, mode: str, *results: FunctionResult) -> Path:
    found = recorder(folder, mode)
    for r in results:
        found.add(r)
    return found.write()


def test_record_keeps_other_modes_and_one_line_per_function(tmp_path: Path) -> None:
    kept(tmp_path, "default", result("sin_angle", 2.5e-7), result("mirror", 1e-7))
    path = kept(tmp_path, "pair", result("sin_angle", 3e-7))
    assert path.name == "pocl-3.1+debian.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    assert set(data["modes"]) == {"default", "pair"}
    entry = data["modes"]["default"]["functions"]["sin_angle"]
    assert (entry["inputs"], entry["permitted"], entry["table"]) == (10, "permitted", "opencl")
    assert entry["unguaranteed"] == 2
    assert entry["accuracy"] == [
        {
            "measure": "relative",
            "floor": 1.5e-4,
            "maximum": 2.5e-7,
            "p999": 1.25e-7,
            "median": 6.25e-8,
            "worst": "a 3f800000",
        },
        {"measure": "8-bit steps", "maximum": 0.25, "p999": 0.125, "median": 0.0, "worst": "a 40000000"},
    ]
    assert entry["errors"] == [{"bound": 1e-6, "measured": 2.5e-7, "worst": "a 3f800000"}]
    assert entry["within"] and entry["stage"] == "judged"
    lines = path.read_text(encoding="utf-8").splitlines()
    assert sum('"sin_angle":' in line for line in lines) == 2


def test_functions_that_were_not_run_keep_what_was_recorded(tmp_path: Path) -> None:
    kept(tmp_path, "default", result("sin_angle", 2.5e-7), result("mirror", 1e-7))
    path = kept(tmp_path, "default", result("mirror", 3e-7))
    recorded = json.loads(path.read_text(encoding="utf-8"))["modes"]["default"]
    measured = {name: f["errors"][0]["measured"] for name, f in recorded["functions"].items()}
    assert measured == {"sin_angle": 2.5e-7, "mirror": 3e-7}


def test_functions_that_are_gone_leave_the_record(tmp_path: Path) -> None:
    path = kept(tmp_path, "default", result("sin_angle", 2.5e-7), result("mirror", 1e-7))
    text = path.read_text(encoding="utf-8").replace('"mirror":', '"mirror_of_old":')
    path.write_text(text, encoding="utf-8")
    kept(tmp_path, "default", result("half_vector", 1e-7))
    functions = read_all(tmp_path)[path.stem]["modes"]["default"]["functions"]
    assert set(functions) == {"sin_angle", "half_vector"}


def test_interrupted_run_keeps_what_it_had(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(record, "WRITE_SECONDS", 0.0)
    interrupted = recorder(tmp_path, "default")
    interrupted.add(result("sin_angle", 2.5e-7))
    assert recorder(tmp_path, "default").current(["sin_angle", "mirror"]) == ["sin_angle"]
    assert recorder(tmp_path, "pair").current(["sin_angle"]) == []


def test_resumed_run_repeats_what_failed_and_what_has_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = result("half_vector", 3e-6)
    known.known = {"within bound": "a driver's way"}
    path = kept(tmp_path, "default", result("sin_angle", 2.5e-7), result("mirror", 3e-6), known)
    names = ["sin_angle", "mirror", "half_vector", "to_local"]
    assert recorder(tmp_path, "default").current(names) == ["sin_angle", "half_vector"]
    text = path.read_text(encoding="utf-8")
    digest = record.fingerprint(load_library(), "sin_angle", "opencl", modes()["default"])
    path.write_text(text.replace(digest, "0" * 16), encoding="utf-8")
    assert recorder(tmp_path, "default").current(names) == ["half_vector"]


@pytest.mark.parametrize("changed", ["pair", "fast-relaxed"])
def test_fingerprint_depends_on_mode_target_and_function(changed: str) -> None:
    library = load_library()
    base = record.fingerprint(library, "mirror", "opencl", modes()["default"])
    assert base != record.fingerprint(library, "mirror", "opencl", modes()[changed])
    assert base != record.fingerprint(library, "mirror", "glsl", modes()["default"])
    assert base != record.fingerprint(library, "to_local", "opencl", modes()["default"])


def test_infinite_numbers_are_text(tmp_path: Path) -> None:
    odd = result("mirror", 0.0)
    odd.bounds[0].measured, odd.bounds[0].failures = float("inf"), 1
    text = kept(tmp_path, "default", odd).read_text(encoding="utf-8")
    assert "Infinity" not in text
    assert json.loads(text)["modes"]["default"]["functions"]["mirror"]["excess"] == "inf"


def test_results_of_other_sources_are_stale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(record, "fingerprint", lambda *_: "")
    path = kept(tmp_path, "default", *(result(name, 1e-7) for name in load_library().public))
    assert list(stale(load_library(), read_all(tmp_path))) == []
    data = json.loads(path.read_text(encoding="utf-8"))
    data["modes"]["default"]["functions"]["mirror"]["judged"] = "other"
    assert list(stale(load_library(), {"pocl": data})) == [("pocl", "default", ["mirror"])]


@pytest.mark.parametrize(
    ("shown", "words"),
    [
        ("x = 0.1 [3dcccccd]", "x 3dcccccd"),
        ("t = (0, 1) [00000000 3f800000], x = 1 [3f800000]", "t 00000000 3f800000, x 3f800000"),
        (
            "o = {x: 1 [3f800000], y: {z: 2 [40000000]}}, b = 3 [40400000]",
            "o.x 3f800000, o.y.z 40000000, b 40400000",
        ),
        ("", ""),
    ],
)
def test_worst_input_is_kept_as_words(shown: str, words: str) -> None:
    assert hex_words(shown) == words


def test_page_tells_shares_and_failures(tmp_path: Path) -> None:
    known = result("mirror", 3e-6)
    known.known = {"within bound": "a driver's |way|"}
    out, whole = result("to_local", 1e-7), result("half_vector", 5e-7)
    out.permitted = IntervalResult("opencl", 10, 9, outside=1, excess=1.25, worst="x = 1 [3f800000]")
    whole.permitted, whole.accuracy = IntervalResult("opencl", 10, 10), [Accuracy("ULP", maximum=1.5)]
    results = [result("sin_angle", 2.5e-7), known, out, whole, result("hammersley", 0.0, "compile")]
    kept(tmp_path, "default", *results)
    text = page(read_all(tmp_path))
    assert "| pocl-3.1+debian | default | 5 | 5 | 4 | 4 | 4 | 3 | 1 | 0 | 12 % | 50 |" in text
    assert "| sin_angle | 0.25? |" in text
    assert "| half_vector | 0.5 |" in text
    assert "| mirror | known |" in text
    assert "| to_local | **not permitted** |" in text
    assert "| hammersley | compile |" in text
    assert "| mirror | pocl-3.1+debian | default | within bound | 3 of its bound | 1 |" in text
    assert "\n1. a driver's |way|\n" in text
    told = "1 of 10 results, by up to 1.2 half widths | not a known failure"
    assert f"| to_local | pocl-3.1+debian | default | permitted | {told} |" in text
    assert "| half_vector | 1.5 ULP |" in text
    assert "| sin_angle | 0.25 steps |" in text


def test_file_of_an_older_format_is_named_and_replaced(tmp_path: Path) -> None:
    path = kept(tmp_path, "default", result("sin_angle", 2.5e-7))
    old = path.read_text(encoding="utf-8").replace('"format": 2', '"format": 1')
    path.write_text(old.replace('"permitted"', '"allowed"'), encoding="utf-8")
    text = page(read_all(tmp_path))
    assert "of an older format, left out below: record it again" in text
    assert "| sin_angle |" not in text
    assert recorder(tmp_path, "default").current(["sin_angle"]) == []
    kept(tmp_path, "pair", result("mirror", 1e-7))
    assert set(read_all(tmp_path)[path.stem]["modes"]) == {"pair"}


def test_committed_page_is_up_to_date() -> None:
    told = "conformance/results/README.md is not what its JSON files give: run python -m conformance.results"
    assert page(read_all()) == (FOLDER / "README.md").read_text(encoding="utf-8"), told


def test_recorded_files_are_of_known_drivers() -> None:
    recorded = read_all()
    assert recorded
    for stem, data in recorded.items():
        assert driver(data["driver"]).slug(Device(**data["device"])) == stem
        assert set(data["modes"]) <= set(modes())
    assert {data["driver"] for data in recorded.values()} <= set(catalogue())
