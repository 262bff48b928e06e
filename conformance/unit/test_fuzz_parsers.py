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
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from codegen.errors import LONGEST, UserError
from conformance.check.merge import merge
from conformance.fuzz_parsers import sandbox as sandboxes
from conformance.fuzz_parsers.documents import as_json, as_toml
from conformance.fuzz_parsers.mutation import VALUES, mutated
from conformance.fuzz_parsers.parsers import PARSERS, Parser
from conformance.fuzz_parsers.sandbox import Hangs, Outside, Sandbox, examine

RUNS = {"lock": 20, "kit": 40, "results": 40}
"""Files a reader, 80 if not named: these take longer."""
SEED = 20_268


@pytest.fixture(scope="module", params=PARSERS)
def named(request: pytest.FixtureRequest) -> Iterator[tuple[str, Parser]]:
    yield request.param, PARSERS[request.param]()


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
    return json.dumps([PARSERS["results"]().trees[1][0] | given])


def _computed(word: str) -> str:
    """Results of a kit with this word."""
    tree = copy.deepcopy(PARSERS["kit"]().trees[0])
    tree["functions"]["sin_angle"]["rows"] = [[word]]
    return json.dumps(tree)


DEEP = "[" * 5000
FINDINGS = {
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
    "negative word of a result": ("kit", _computed("-f800000"), 'holds "-f800000"'),
}


@pytest.mark.parametrize("name", FINDINGS)
def test_findings_get_a_sentence(name: str, box: Sandbox) -> None:
    reader, text, sentence = FINDINGS[name]
    parser = PARSERS[reader]()
    assert sentence in examine(box, parser.read, parser.file, text.encode())


@pytest.mark.parametrize("key", ["skipped", "shard", "source"])
def test_a_result_with_a_number_for_a_text_is_none(key: str, tmp_path: Path) -> None:
    (tmp_path / "r.json").write_text(json.dumps({"results": [], key: 1}))
    with pytest.raises(UserError, match="is no result of vair check --json"):
        merge([tmp_path / "r.json"])


@pytest.mark.parametrize(("key", "value"), [("function", []), ("lanes", "many"), ("seconds", True)])
def test_a_result_with_a_field_of_another_type_is_refused(key: str, value: Any, tmp_path: Path) -> None:
    whole = json.loads(PARSERS["results"]().seeds[0])
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


def test_trees_are_written_as_they_are_read() -> None:
    def plain(value: Any) -> bool:
        return value is not None and not (isinstance(value, float) and math.isnan(value)) and value != 10**400

    values = [v for v in VALUES if plain(v) and v != "\ud800" and not (isinstance(v, list) and None in v)]
    tree = {"top": values, "table": {"a b": 1.5, "é": {"inner": [True, "x\ny"]}}}
    assert tomllib.loads(as_toml(tree)) == tree
    assert json.loads(as_json(tree)) == tree
