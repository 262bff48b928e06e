"""Results of a kit that cannot be judged are refused with one sentence, whatever is wrong with their file.

Plan. Right results are changed in one way each.
  refused  missing lanes, missing rows, other functions, versions, inputs, targets and tables
  damage   files that are no results at all; bytes changed, left out and doubled at random places
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.kit.results import read_results
from codegen.library import load_library
from codegen.version import VERSION
from conformance.unit.kit.small_kit import Data, copy, judged

SEED = 20261122
DAMAGES = 300
Capture = pytest.CaptureFixture[str]


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
