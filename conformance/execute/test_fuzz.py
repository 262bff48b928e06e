"""Random programs of the source subset do on every target what the IR says.

Plan.
  programs   random sources with structs, helpers, branches, loops and every built-in go through the front
             end, are emitted, compiled and executed, and every result is held against the interval that the
             target's accuracy table permits; so are the IR's evaluator and Python executing the source
  breakage   a printer, an evaluator and a driver that are broken on purpose are found, and each finding is
             reduced to a few IR nodes that fail in the same way
  round trip reduced programs are shown as sources: the front end reads them back to the same IR
Known benign differences are kept out by the generator: see conformance/fuzz/expressions.py.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.emit import precedence
from codegen.errors import UserError
from codegen.execute import Words
from conformance.fuzz.case import HEADER, Case, draw_inputs, make_case
from conformance.fuzz.engine import LANES, Finding, Tally, run_cases
from conformance.fuzz.reduce import Reduced, reduce, wrong_value
from conformance.fuzz.report import explain
from conformance.fuzz.source import write
from conformance.fuzz.unparse import functions_text
from targets import Runtime, TimedRuntime

SEED = 1
COUNT = {"glsl": 1_000, "wgsl": 1_000, "opencl": 200}
"""Programs of a normal run. PoCL compiles ten times as slowly as llvmpipe."""
NIGHTLY = 100_000
SMALL = 10
"""IR nodes to which a failing program is to be reduced."""


def assert_none(tally: Tally, runtimes: list[Runtime]) -> None:
    shown = "\n\n".join(explain(finding, runtimes) for finding in tally.findings[:3])
    assert not tally.findings, "\n".join([*tally.lines(), shown])


def test_random_programs_are_right(runtime: TimedRuntime) -> None:
    tally = Tally()
    run_cases(range(COUNT[runtime.device.target]), SEED, [runtime], tally)
    print("\n".join(tally.lines()))
    assert_none(tally, [runtime])


@pytest.mark.nightly
@pytest.mark.timeout(4 * 3600)
def test_many_random_programs_are_right(runtime: TimedRuntime) -> None:
    tally = Tally()
    run_cases(range(NIGHTLY), SEED + 1, [runtime], tally)
    print("\n".join(tally.lines()))
    assert_none(tally, [runtime])


def first_value_finding(runtimes: list[Runtime], most: int = 400) -> Finding:
    """The first wrong value that random programs show."""
    for start in range(0, most, 40):
        tally = Tally()
        run_cases(range(start, start + 40), SEED, runtimes, tally)
        wrong = [f for f in tally.findings if f.kind == "value" and f.backend != "python"]
        if wrong:
            return wrong[0]
    pytest.fail(f"{most} random programs did not show the damage")


def reduced(finding: Finding, runtime: Runtime | None, folder: Path) -> Reduced:
    library = write(folder, [finding.case])
    inputs = draw_inputs(finding.case, library.function(finding.case.entry).parameters, LANES)
    fails = wrong_value(inputs, finding.lane, runtime)
    found = reduce(library, finding.case.entry, fails)
    assert fails(found.library, finding.case.entry)
    return found


def loosen_sums(monkeypatch: pytest.MonkeyPatch) -> None:
    """A printer that drops the parentheses of a - (b - c)."""
    monkeypatch.setitem(precedence.RIGHT, "sum", precedence.RIGHT["sum"] | {"sum"})


def loosen_products(monkeypatch: pytest.MonkeyPatch) -> None:
    """A printer that drops the parentheses of a * (b + c)."""
    monkeypatch.setitem(precedence.RIGHT, "product", precedence.RIGHT["product"] | {"sum"})


@pytest.mark.parametrize("damage", [loosen_sums, loosen_products], ids=["sum", "product"])
def test_a_broken_printer_is_found_and_reduced(
    damage: Callable[[pytest.MonkeyPatch], None],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    runtime: TimedRuntime,
) -> None:
    if runtime.device.target == "opencl":
        pytest.skip("the printer is shared; one compiler's speed decides where it is damaged")
    damage(monkeypatch)
    found = reduced(first_value_finding([runtime]), runtime, tmp_path)
    assert found.nodes <= SMALL, functions_text(found.functions)


class BadDevice:
    """A device that adds one to every word it stores, from some lane on."""

    def __init__(self, device: Any) -> None:
        self.device = device

    def run(self, program: str, words: Words, slots_out: int) -> Words:
        return np.zeros((slots_out, words.shape[1]), np.uint32) + np.uint32(0x40000000)


def test_a_broken_device_is_found_and_reduced(tmp_path: Path, runtime: TimedRuntime) -> None:
    bad = BadDevice(runtime.device)
    found = reduced(first_value_finding([bad]), bad, tmp_path)
    assert found.nodes <= 2, functions_text(found.functions)


def test_findings_are_told_with_their_replay(runtime: TimedRuntime) -> None:
    bad = BadDevice(runtime.device)
    finding = first_value_finding([bad])
    text = explain(finding, [bad])
    assert f"--seed {SEED} --case {finding.case.number}" in text
    assert "reduced to" in text
    assert finding.case.text in text


@pytest.mark.parametrize("number", range(40))
def test_programs_read_back_from_their_ir(number: int, tmp_path: Path) -> None:
    """Front end, then source text of the IR, then front end again: the same IR but for source lines."""
    case = make_case(SEED, number)
    selection = write(tmp_path / "first", [case]).select([case.entry])
    text = functions_text(selection.functions, selection.structs)
    again = write(tmp_path / "second", [Case(SEED, number, text, case.entry)]).select([case.entry])
    assert [f.body for f in again.functions] == [f.body for f in selection.functions], HEADER + text


def test_a_program_is_the_same_each_time() -> None:
    assert make_case(SEED, 7) == make_case(SEED, 7)
    assert make_case(SEED, 7).text != make_case(SEED, 8).text


def test_an_invalid_program_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*args: object) -> None:
        raise UserError("no")

    monkeypatch.setattr("conformance.fuzz.engine.verify_selection", refuse)
    tally = Tally()
    run_cases(range(1), SEED, [], tally)
    assert [f.signature for f in tally.findings] == [("refused", "front end")]
