"""Recorded results: what is kept of a run, and the page made of it.

Plan.
  record  one line per function, worst inputs as words, other modes of a file stay
  page    counts, shares, known and unknown failures; the committed page is what the committed files give
"""

from __future__ import annotations

import datetime
import json
from pathlib import Path

import pytest

from codegen.library import load_library
from conformance.check.result import BoundResult, FunctionResult
from conformance.drivers.matrix import page
from conformance.drivers.modes import modes
from conformance.drivers.record import FOLDER, hex_words, keep, read_all, stale
from conformance.drivers.run import DriverRun
from targets import Device
from targets.drivers import catalogue, driver

DEVICE = Device("opencl", "OpenCL 3.0", "Portable Computing Language 3.1+debian", "pthread")
DAY = datetime.date(2026, 6, 1)


def result(name: str, measured: float, stage: str = "judged") -> FunctionResult:
    r = FunctionResult(name, "opencl", "a driver", lanes=10, backend="pocl+default", stage=stage)
    r.bounds = [BoundResult("b", 1e-6, measured, worst="a = 1 [3f800000]", failures=int(measured > 1e-6))]
    if measured > 1e-6:
        r.failures = [None]  # type: ignore[list-item]  # only whether there is one counts here
    if stage != "judged":
        r.broken = "does not compile: line 3"
    return r


def kept(folder: Path, mode: str, *results: FunctionResult) -> Path:
    run = DriverRun(driver("pocl"), DEVICE, modes()[mode], results)
    (path,) = keep(load_library(), [run], DAY, folder)
    return path


def test_record_keeps_other_modes_and_one_line_per_function(tmp_path: Path) -> None:
    kept(tmp_path, "default", result("sin_angle", 2.5e-7), result("mirror", 1e-7))
    path = kept(tmp_path, "pair", result("sin_angle", 3e-7))
    assert path.name == "pocl-3.1+debian.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    assert set(data["modes"]) == {"default", "pair"}
    assert data["modes"]["default"]["inputs"] == 20
    entry = data["modes"]["default"]["functions"]["sin_angle"]
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
    assert recorded["inputs"] == 20


def test_results_of_other_sources_are_stale(tmp_path: Path) -> None:
    path = kept(tmp_path, "default", *(result(name, 1e-7) for name in load_library().public))
    assert list(stale(load_library(), read_all(tmp_path))) == []
    data = json.loads(path.read_text(encoding="utf-8"))
    data["modes"]["default"]["functions"]["mirror"]["sources"] = "other"
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
    known.known = "a driver's way"
    kept(tmp_path, "default", result("sin_angle", 2.5e-7), known, result("hammersley", 0.0, "compile"))
    text = page(read_all(tmp_path))
    assert "| pocl-3.1+debian | default | 3 | 3 | 2 | 2 | 1 | 1 | 0 | 30 |" in text
    assert "| sin_angle | 0.25 |" in text
    assert "| mirror | known |" in text
    assert "| hammersley | compile |" in text
    assert "| mirror | pocl-3.1+debian | default | 3 of its bound | a driver's way |" in text


def test_committed_page_is_up_to_date() -> None:
    assert page(read_all()) == (FOLDER / "README.md").read_text(encoding="utf-8"), (
        "run python -m conformance.results"
    )


def test_recorded_files_are_of_known_drivers() -> None:
    recorded = read_all()
    assert recorded
    for stem, data in recorded.items():
        assert driver(data["driver"]).slug(Device(**data["device"])) == stem
        assert set(data["modes"]) <= set(modes())
    assert {data["driver"] for data in recorded.values()} <= set(catalogue())
