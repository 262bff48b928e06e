"""Failures as records that replay anywhere; shards that together are the whole; results that are joined."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.library import load_library
from conformance.check.engine import Backend, check_function
from conformance.check.replay import records
from conformance.check.result import FunctionResult
from conformance.check.shard import Shard

FUNCTION = "sin_angle"
GOOD = {"finite": True, "permitted": "permitted", "within bound": True}


def worse(library: Any, name: str, inputs: Any) -> Any:
    """The evaluator, off by a thousandth."""
    return np.float32(1.001) * np.asarray(evaluate(library, name, inputs))


@pytest.fixture(scope="module")
def bad_result() -> FunctionResult:
    return check_function(load_library(), FUNCTION, Backend("numpy", "a bad driver", worse))


def write(path: Path, results: list[FunctionResult], shard: str = "1/1", source: str = "s") -> Path:
    data = {"source": source, "shard": shard, "skipped": [], "results": [r.as_data() for r in results]}
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


def test_a_record_holds_all_that_replaying_needs(bad_result: FunctionResult) -> None:
    record = bad_result.as_data()["failures"][0]
    assert record["function"] == FUNCTION
    assert record["driver"] == "a bad driver"
    assert record["source"] == load_library().select([FUNCTION]).source_hash
    needed = {"got", "expected", "exact", "interval", "low", "high", "seed", "emitted", "program", "missed"}
    assert needed <= set(record)
    assert record["failed"] == ["permitted", "within bound"]
    assert record["low"] <= float(record["exact"]) <= record["high"] < float(record["got"].split()[0])
    words = dict(part.split("=") for part in record["words"].split(";"))
    assert set(words) == {"a", "b"}
    assert all(len(word) == 8 for text in words.values() for word in text.split())
    assert all(word in record["inputs"] for text in words.values() for word in text.split())


def test_results_survive_json(bad_result: FunctionResult) -> None:
    data = json.loads(json.dumps(bad_result.as_data()))
    assert FunctionResult.from_data(data).as_data() == data


def test_replay_runs_every_failure_of_a_file(
    bad_result: FunctionResult, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "bad.json", [bad_result])
    assert run(["check", "--replay", str(path)]) == 0, "the evaluator itself is within its bounds"
    told = capsys.readouterr().out
    assert told.count("recorded") == len(bad_result.failures)
    assert bad_result.failures[0].got in told
    assert "the sources have changed" not in told


def test_replay_says_that_sources_have_changed(
    bad_result: FunctionResult, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = {**bad_result.as_data()["failures"][0], "source": "old"}
    path = tmp_path / "record.json"
    path.write_text(json.dumps(record), encoding="utf-8")
    assert run(["check", "--replay", str(path)]) == 0
    assert "the sources have changed since" in capsys.readouterr().out


@pytest.mark.parametrize("text", ["no json", "[]", '{"results": []}', '[{"words": "a=0", "function": "no"}]'])
def test_replay_refuses_what_is_no_record(text: str, tmp_path: Path) -> None:
    path = tmp_path / "file.json"
    path.write_text(text, encoding="utf-8")
    assert run(["check", "--replay", str(path)]) == 2


def test_shards_are_disjoint_and_whole() -> None:
    pairs = [(name, target) for name in load_library().public for target in ("glsl", "wgsl", "opencl")]
    for of in (1, 2, 3, 7):
        parts = [[pair for pair in pairs if Shard(k, of).holds(*pair)] for k in range(1, of + 1)]
        assert sorted(pair for part in parts for pair in part) == sorted(pairs)
        assert all(len(part) > len(pairs) / of / 2 for part in parts)


@pytest.mark.parametrize("text", ["", "0/2", "3/2", "1", "a/b", "-1/2", "1/0"])
def test_what_is_no_shard_is_refused(text: str) -> None:
    assert run(["check", "--shard", text]) == 2


def test_merged_shards_are_the_whole(tmp_path: Path) -> None:
    names = ["sin_angle", "safe_sqrt", "half_vector", "mirror"]
    chosen = [argument for name in names for argument in ("--function", name)]
    files = []
    for k in (1, 2, 3):
        files.append(str(tmp_path / f"{k}.json"))
        done = run(["check", "--target", "numpy", *chosen, "--shard", f"{k}/3", "--json", files[-1]])
        assert done == 0
    merged = tmp_path / "merged.json"
    junit = tmp_path / "merged.xml"
    assert run(["check", "--merge", *files, "--json", str(merged), "--junit", str(junit)]) == 0
    data = json.loads(merged.read_text(encoding="utf-8"))
    assert sorted(r["function"] for r in data["results"]) == sorted(names)
    assert all(r["verdicts"] == dict(GOOD) for r in data["results"])
    assert all(r["permitted"]["lanes"] == r["lanes"] for r in data["results"])
    assert junit.read_text(encoding="utf-8").count("<testcase") == 2 * len(names)
    assert run(["check", "--merge", *files[:2]]) == 1, "a shard is missing"


def test_merging_keeps_a_failure(bad_result: FunctionResult, tmp_path: Path) -> None:
    good = FunctionResult(FUNCTION, "numpy", "a bad driver", backend="numpy")
    first, second = write(tmp_path / "a.json", [good]), write(tmp_path / "b.json", [bad_result])
    assert run(["check", "--merge", str(first)]) == 0
    assert run(["check", "--merge", str(first), str(second)]) == 1
    assert run(["check", "--merge", str(second), str(first)]) == 1


def test_merging_refuses_other_sources_and_other_files(tmp_path: Path) -> None:
    first, second = write(tmp_path / "a.json", []), write(tmp_path / "b.json", [], source="t")
    assert run(["check", "--merge", str(first), str(second)]) == 2
    second.write_text("{}", encoding="utf-8")
    assert run(["check", "--merge", str(second)]) == 2
    assert run(["check", "--merge", str(tmp_path / "none.json")]) == 2
    assert run(["check", "--merge"]) == 2
    assert run(["check", str(first)]) == 2


@pytest.mark.parametrize("text", ['{"results": [{}]}', '{"results": 5}', '{"results": [7]}'])
def test_what_only_looks_like_a_result_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(text)
    with pytest.raises(UserError, match=r"a\.json is no result of vair check --json"):
        records(path)
