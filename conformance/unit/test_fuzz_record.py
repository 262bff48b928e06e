"""The record of random programs: runs of a seed follow each other, and no program is counted twice.

Plan.
  record     a run continues the one before, of the same sources; another seed, target or source stands alone
  again      findings that are right now become mended, others stay, and the file holds both
  committed  what is recorded found nothing that is not mended
Not covered here: the programs themselves (execute/test_fuzz.py).
"""

from __future__ import annotations

from datetime import date
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner

from conformance.fuzz import __main__ as command
from conformance.fuzz import record
from conformance.fuzz.case import make_case
from conformance.fuzz.engine import Finding, Tally

TODAY = date(2026, 11, 22)


def run(first: int, programs: int, seed: int = 2, target: str = "glsl", **changed: Any) -> record.Entry:
    tally = Tally(programs)
    tally.results["glsl"] = 32 * programs
    tally.open["glsl"] = programs
    return {**record.entry(tally, seed, first, [target], TODAY), **changed}


def test_run_continues_the_one_before() -> None:
    entries = record.added(record.added([], run(0, 40)), run(40, 10))
    (joined,) = entries
    assert (joined["first"], joined["programs"]) == (0, 50)
    assert (joined["results"], joined["open"]) == ({"glsl": 1600}, {"glsl": 50})
    assert record.following(entries, 2, ["glsl"]) == 50


@pytest.mark.parametrize(
    "other", [run(40, 10, seed=3), run(40, 10, target="wgsl"), run(40, 10, source="0"), run(60, 10)]
)
def test_other_runs_stand_alone(other: record.Entry) -> None:
    assert record.added([run(0, 40)], other) == [run(0, 40), other]


def test_programs_of_other_sources_are_not_run_again() -> None:
    entries = [run(0, 40, source="0"), run(40, 10)]
    assert record.following(entries, 2, ["glsl"]) == 50
    assert record.following(entries, 2, ["wgsl"]) == record.following(entries, 3, ["glsl"]) == 0


def test_findings_are_kept_in_words(tmp_path: Path) -> None:
    tally = Tally(1, findings=[Finding(make_case(2, 7), "value", "glsl", "lane 3 is wrong")])
    entries = record.added([run(0, 7)], record.entry(tally, 2, 7, ["glsl"], TODAY))
    record.write(entries, tmp_path / "results.json")
    assert record.read(tmp_path / "results.json") == entries
    assert "--seed 2 --case 7" in entries[0]["findings"][0]


def test_command_goes_on_where_the_record_ends(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    monkeypatch.setattr(command, "open_targets", lambda names: [])
    asked: list[range] = []

    def counted(numbers: range, seed: int, runtimes: list[Any], tally: Tally) -> None:
        asked.append(numbers)
        tally.programs += len(numbers)

    monkeypatch.setattr(command, "run_cases", counted)
    for count in ("30", "12"):
        options = ["--record", "--results", str(path), "--seed", "5", "--count", count]
        assert CliRunner().invoke(command.main, options).exit_code == 0
    assert asked == [range(0, 30), range(30, 42)]
    (entry,) = record.read(path)
    assert (entry["seed"], entry["programs"]) == (5, 42)
    refused = CliRunner().invoke(command.main, ["--record", "--first", "3"])
    assert refused.exit_code == 2 and "takes no --case" in refused.output


def found(number: int) -> Finding:
    return Finding(make_case(2, number), "value", "glsl", f"lane {number} is wrong")


def test_findings_that_are_right_now_are_mended() -> None:
    tally = Tally(9, findings=[found(5), found(7)])
    other = run(0, 40, seed=3)
    entries = [record.entry(tally, 2, 0, ["glsl"], TODAY), other]
    asked: list[tuple[int, int, list[str]]] = []

    def once_more(seed: int, number: int, targets: list[str]) -> Tally:
        asked.append((seed, number, targets))
        return Tally(1, findings=[found(7)] if number == 7 else [])

    after = record.checked_again(entries, once_more)
    assert asked == [(2, 5, ["glsl"]), (2, 7, ["glsl"])]
    assert after[0]["mended"] == [5] and list(map(record.number_of, after[0]["findings"])) == [7]
    assert after[1] == other
    joined = record.added(after, {**run(9, 1), "mended": [9]})
    assert joined[0]["mended"] == [5, 9] and joined[0]["findings"] == after[0]["findings"]


@pytest.mark.parametrize(("still_wrong", "status"), [(False, 0), (True, 1)])
def test_command_runs_findings_again(
    still_wrong: bool, status: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = tmp_path / "results.json"
    record.write([record.entry(Tally(1, findings=[found(7)]), 2, 7, ["glsl"], TODAY)], path)
    monkeypatch.setattr(
        command,
        "open_targets",
        lambda names: [SimpleNamespace(device=SimpleNamespace(target=n)) for n in names],
    )
    monkeypatch.setattr(
        command,
        "run_cases",
        lambda numbers, seed, runtimes, tally: tally.findings.extend([found(7)] * still_wrong),
    )
    done = CliRunner().invoke(command.main, ["--again", "--results", str(path)])
    assert done.exit_code == status
    assert ("0 mended, 1 left" if still_wrong else "1 mended, 0 left") in done.output
    (entry,) = record.read(path)
    assert (entry["mended"], len(entry["findings"])) == (([], 1) if still_wrong else ([7], 0))


def test_findings_of_a_target_that_is_not_here_stay(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    entries = [record.entry(Tally(1, findings=[found(7)]), 2, 7, ["glsl"], TODAY)]
    record.write(entries, path)
    monkeypatch.setattr(command, "open_targets", lambda names: [])
    refused = CliRunner().invoke(command.main, ["--again", "--results", str(path)])
    assert refused.exit_code == 2 and "case 7 was run on glsl, which is not here" in refused.output
    assert record.read(path) == entries
    refused = CliRunner().invoke(command.main, ["--again", "--record", "--results", str(path)])
    assert refused.exit_code == 2 and "takes no --case" in refused.output


def test_what_is_recorded_found_nothing() -> None:
    entries = record.read()
    if not entries:
        pytest.skip("python -m conformance.fuzz --record writes it")
    assert not [finding for entry in entries for finding in entry["findings"]]
