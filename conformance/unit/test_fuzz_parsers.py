"""Readers of files that people hand over say one sentence or take the file; nothing else comes out.

Plan.
  drawn      every reader on seeded damage of its files (by coverage and longer: conformance.fuzz_parsers)
  seeds      what damage starts from is itself taken, else it would end at the first check
  findings   files that once brought a traceback, a sentence of several lines or of any length
  sandbox    a write elsewhere, a run without end and an error of another kind are noticed
  damage     the same bytes give the same file; trees are written as they are read
"""

import copy
import json
import math
import random
import subprocess
import sys
import time
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import LONGEST, UserError
from codegen.strands.tfx import tfx
from conformance.check.merge import merge
from conformance.fuzz_parsers import record
from conformance.fuzz_parsers import sandbox as sandboxes
from conformance.fuzz_parsers.archives import as_npz
from conformance.fuzz_parsers.campaign import lacking
from conformance.fuzz_parsers.documents import as_json, as_toml
from conformance.fuzz_parsers.mutation import VALUES, mutated
from conformance.fuzz_parsers.parser import Parser
from conformance.fuzz_parsers.parsers import PARSERS
from conformance.fuzz_parsers.readers import MODULES, code_hash, sources
from conformance.fuzz_parsers.sandbox import Hangs, Outside, Sandbox, examine

RUNS = {"lock": 20, "kit": 40, "results": 40}
"""Files a reader, 80 if not named: these take longer."""
SEED = 20_268


@cache
def made(name: str) -> Parser:
    return PARSERS[name]()


@pytest.fixture(params=PARSERS)
def named(request: pytest.FixtureRequest) -> tuple[str, Parser]:
    return request.param, made(request.param)


@pytest.fixture
def box(tmp_path: Path) -> Sandbox:
    return Sandbox(tmp_path)


@pytest.mark.parametrize("times", [1, pytest.param(50, marks=pytest.mark.nightly)])
def test_seeded_damage_gets_a_sentence(times: int, named: tuple[str, Parser], box: Sandbox) -> None:
    name, parser = named
    drawn = random.Random(f"{SEED} {times} {name}")
    for _ in range(times * RUNS.get(name, 80)):
        data = drawn.randbytes(drawn.randrange(200))
        print(f"python -m conformance.fuzz_parsers {name} --replay {data.hex()}")
        examine(box, parser.read, parser.file, mutated(data, parser.seeds, parser.trees, parser.write))


def test_a_seed_is_taken(named: tuple[str, Parser], box: Sandbox) -> None:
    """Of the seeds one at least; the others begin in what is refused."""
    _, parser = named
    said = [examine(box, parser.read, parser.file, seed) for seed in parser.seeds]
    assert "" in said


def _record(**given: str) -> str:
    """A failure as `vair check --json` writes it, with other fields."""
    return json.dumps([made("results").trees[1][0] | given])


def _computed(word: str) -> str:
    """Results of a kit with this word."""
    tree = copy.deepcopy(made("kit").trees[0])
    tree["functions"]["sin_angle"]["rows"] = [[word]]
    return json.dumps(tree)


def _sampled(l: list[float] | None = None, dtype: str = "float64") -> bytes:
    """Samples of a reflectance as .npz, l of other values."""
    tree = copy.deepcopy(made("samples_npz").trees[0])
    tree["l"] |= {"dtype": dtype, "values": l or [0.0, 0.0, 1.0]}
    return as_npz(tree)


DEEP = "[" * 5000
FINDINGS: dict[str, tuple[str, str | bytes, str]] = {
    "value nested too deeply": ("scene", f"a = {DEEP}", "is nested too deeply"),
    "number of thousands of digits": ("scene", f"a = {'9' * 5000}", "is not valid TOML: Exceeds the limit"),
    "number beyond any float": ("picture", f"[fur]\nlength = {10**400}", "length: must be a number"),
    "key with an end of line": ("scene", '"a\\nb" = 1', 'unknown table or key "a\\nb"'),
    "key with an escape of terminals": ("scene", '"\\u001b[2J" = 1', 'unknown table or key "\\x1b[2J"'),
    "long value": ("waterloo", f"x\n0\n{'y' * 9000}\n", "the scale is three numbers"),
    "long column": ("samples", f"l.{'x' * 9000}\n1\n", 'the column "l.x" is missing'),
    "header that is a lone sign of comments": ("samples", "#", "not a table of numbers"),
    "function as a number": (
        "results",
        '[{"function": 1, "identity": "x", "words": ""}]',
        "function, identity and words are texts",
    ),
    "accuracy beyond any float": (
        "results",
        json.dumps(made("results").trees[0]).replace('"maximum": 1.', f'"maximum": 1{"0" * 400}, "x": 1.'),
        "int too large to convert to float",
    ),
    "shard of a million": (
        "results",
        json.dumps(made("results").trees[0] | {"shard": "1/999999"}),
        '"1/999999" is no shard',
    ),
    "JSON nested too deeply": ("results", DEEP, "is nested too deeply"),
    "word of more than 32 bits": (
        "results",
        _record(words="hair_length=13f800000;radius_base=3f800000;radius_tip=3f000000"),
        "hair_length: 13f800000 is no word of 8 hexadecimal digits",
    ),
    "negative word": (
        "results",
        _record(words="hair_length=-f800000;radius_base=3f800000;radius_tip=3f000000"),
        "hair_length: -f800000 is no word of 8 hexadecimal digits",
    ),
    "identity of a draw that no memory holds": (
        "results",
        _record(identity="fur_hair_area/numpy/uniform/1000000000000/0/3", words=""),
        "names a draw of 1000000000000 lanes",
    ),
    "identity with a negative seed": (
        "results",
        _record(identity="fur_hair_area/numpy/uniform/16/-1/3", words=""),
        "is no replay identity",
    ),
    "vertex of two coordinates": ("mesh", "v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "not of three coordinates"),
    "signalling NaN in strands": (
        "strands",
        tfx(np.zeros((1, 2, 3)))[:-16] + bytes.fromhex("0100807f") * 4,
        "has a point that is not finite",
    ),
    "direction of a length beyond floats": ("samples_npz", _sampled(l=[1e308]), "is no unit vector"),
    "directions of complex numbers": (
        "samples_npz",
        _sampled(dtype="complex64"),
        "holds complex64 instead of numbers",
    ),
    "result in a report that is none": (
        "report",
        json.dumps({"schema": 1, "drivers": [0]}),
        "results of another schema",
    ),
    "report without a time": (
        "report",
        json.dumps(made("report").trees[0]).replace("net_ns", "ns"),
        "lacks or misspells 'net_ns'",
    ),
    "scene's report with a text for a time": (
        "scene_report",
        json.dumps(made("scene_report").trees[0]).replace('"ratio": 0.', '"ratio": "x", "o": 0.'),
        "lacks or misspells",
    ),
    "scale that is not finite": ("factors", '{"scale": [1e999], "angles": ""}', "not what"),
    "axis that is no float": (
        "table",
        json.dumps(made("table").trees[0]).replace("-1.0", f"1{'0' * 400}"),
        "not what",
    ),
    "negative word of a result": ("kit", _computed("-f800000"), 'holds "-f800000"'),
}


@pytest.mark.parametrize("name", FINDINGS)
def test_findings_get_a_sentence(name: str, box: Sandbox) -> None:
    reader, content, sentence = FINDINGS[name]
    parser = made(reader)
    data = content.encode() if isinstance(content, str) else content
    assert sentence in examine(box, parser.read, parser.file, data)


@pytest.mark.parametrize("key", ["skipped", "shard", "source"])
def test_a_result_with_a_number_for_a_text_is_none(key: str, tmp_path: Path) -> None:
    (tmp_path / "r.json").write_text(json.dumps({"results": [], key: 1}))
    with pytest.raises(UserError, match="is no result of vair check --json"):
        merge([tmp_path / "r.json"])


@pytest.mark.parametrize(("key", "value"), [("function", []), ("lanes", "many"), ("seconds", True)])
def test_a_result_with_a_field_of_another_type_is_refused(key: str, value: Any, tmp_path: Path) -> None:
    whole = json.loads(made("results").seeds[0])
    whole["results"][0][key] = value
    (tmp_path / "r.json").write_text(json.dumps(whole))
    with pytest.raises(UserError, match=f"a result lacks or misspells {key}: "):
        merge([tmp_path / "r.json"])


def test_sentences_are_one_printable_line_of_some_length() -> None:
    assert str(UserError("a\nb\x1b\u2028c")) == "a\\nb\\x1b\\u2028c"
    assert len(str(UserError("x" * 10**5))) <= LONGEST + len(" ...")


def test_a_write_elsewhere_is_noticed(tmp_path: Path) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "link").symlink_to(tmp_path)
    box = Sandbox(inner)
    targets = [tmp_path / "out", inner / ".." / "out", inner / "link" / "out"]
    for target in targets:
        with pytest.raises(Outside):
            examine(box, lambda path, target=target: target.write_text(""), "x", b"")  # type: ignore[misc]
        with pytest.raises(Outside):
            examine(box, lambda path, target=target: path.rename(target), "x", b"")  # type: ignore[misc]
        with pytest.raises(Outside):
            examine(box, lambda path, target=target: target.mkdir(), "x", b"")  # type: ignore[misc]
    assert not (tmp_path / "out").exists()
    assert examine(box, lambda path: path.with_name("y").write_text(""), "x", b"") == ""


def test_what_a_library_logs_of_a_mesh_is_not_printed(tmp_path: Path) -> None:
    """In a process of its own: pytest takes what is logged."""
    whole = made("mesh_ply").seeds[0]
    (tmp_path / "own.ply").write_bytes(
        whole.replace(b"face 2", b"face 2222").replace(b"0 1 0 255", b"0 1 255")
    )
    code = "import sys; from pathlib import Path; from codegen.fur.meshfile import load_mesh\n"
    code += "load_mesh(Path(sys.argv[1]))"
    command = [sys.executable, "-c", code, str(tmp_path / "own.ply")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == ""


def test_a_run_without_end_is_noticed(box: Sandbox, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sandboxes, "SECONDS", 0.05)
    with pytest.raises(Hangs):
        examine(box, lambda path: time.sleep(5.0), "x", b"")


def test_another_error_is_not_swallowed(box: Sandbox) -> None:
    def read(path: Path) -> Any:
        raise KeyError("x")

    with pytest.raises(KeyError):
        examine(box, read, "x", b"")


def test_damage_repeats_itself(named: tuple[str, Parser]) -> None:
    _, parser = named
    data = random.Random(SEED).randbytes(300)
    once = [mutated(bytes([0, k]) + data, parser.seeds, parser.trees, parser.write) for k in range(4)]
    again = [mutated(bytes([0, k]) + data, parser.seeds, parser.trees, parser.write) for k in range(4)]
    assert once == again
    assert len(set(once)) >= 2


def test_damage_leaves_the_values_that_it_puts_in(named: tuple[str, Parser]) -> None:
    """Else the bytes of a finding would not give its file again."""
    _, parser = named
    before = repr(VALUES)
    drawn = random.Random(SEED)
    for _ in range(300):
        mutated(b"\0\2" + drawn.randbytes(60), parser.seeds, parser.trees, parser.write)
    assert repr(VALUES) == before


def test_modules_of_every_reader_are_named_and_there() -> None:
    assert list(MODULES) == list(PARSERS)
    missing = [str(path) for name in MODULES for path in sources(name) if not path.is_file()]
    assert not missing


def test_the_table_says_what_is_recorded_of_every_reader() -> None:
    found = record.read()
    assert list(found) == list(PARSERS)
    text = record.README.read_text(encoding="utf-8")
    assert record.table(found) == text.partition(record.BEGIN)[2].partition(record.END)[0].strip()
    for name, entry in found.items():
        assert f"`{name}`" in text.partition(record.BEGIN)[0]
        assert entry.runs == entry.taken + entry.refused > 0


def test_a_record_counts_runs_of_one_state_of_the_code() -> None:
    first = record.Record("a").with_run("blind", 3, 5, 1.25, "2026-01-01")
    both = first.with_run("by_coverage", 1, 1, 1.0, "2026-01-02")
    assert (both.blind, both.by_coverage, both.runs, both.taken, both.refused) == (8, 2, 10, 4, 6)
    assert both.seeds == {"by_coverage": 1, "blind": 1} and both.date == "2026-01-02"
    assert record.recorded("scene", "none").runs == 0
    assert record.recorded("scene", record.read()["scene"].code) == record.read()["scene"]


def test_a_campaign_takes_up_what_is_lacking(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = {"mesh": record.Record(code_hash("mesh"), 150, 700), "lock": record.Record("changed", 200, 800)}
    monkeypatch.setattr(record, "read", lambda: entry)
    assert list(lacking(("mesh", "lock"), until=1000, by_coverage=200)) == [
        ("mesh", "by_coverage", 50),
        ("lock", "by_coverage", 200),
        ("mesh", "blind", 150),
        ("lock", "blind", 1000),
    ]


def test_trees_are_written_as_they_are_read() -> None:
    def plain(value: Any) -> bool:
        return value is not None and not (isinstance(value, float) and math.isnan(value)) and value != 10**400

    values = [v for v in VALUES if plain(v) and v != "\ud800" and not (isinstance(v, list) and None in v)]
    tree = {"top": values, "table": {"a b": 1.5, "é": {"inner": [True, "x\ny"]}}}
    assert tomllib.loads(as_toml(tree).decode()) == tree
    assert json.loads(as_json(tree)) == tree
