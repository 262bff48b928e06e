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

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.emit import precedence
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.execute import Words
from conformance.executor import Here, Job, Processes, Result
from conformance.fuzz.case import HEADER, Case, draw_inputs, make_case
from conformance.fuzz.engine import LANES, Finding, Tally, run_cases
from conformance.fuzz.reduce import Reduced, reduce, wrong_value
from conformance.fuzz.report import explain
from conformance.fuzz.source import write
from conformance.fuzz.task import COUNTS, ENDED, TASK, pieces, run_jobs
from conformance.fuzz.unparse import functions_text
from conformance.programs import judge
from targets import TARGETS, Runtime, TargetUnavailable, open_runtime, probe
from targets.textures import TextureData

SEED = 1
COUNT, PARTS = 1_000, 4
"""Programs of a normal run, and the tests that share them."""
SLOW, SLOW_SHARE = ("opencl",), 5
"""PoCL compiles ten times as slowly as llvmpipe: it gets one program in five."""
NIGHTLY = 100_000
SMALL = 10
"""IR nodes to which a failing program is to be reduced."""


def assert_none(tally: Tally, runtimes: list[Runtime]) -> None:
    shown = "\n\n".join(explain(finding, runtimes) for finding in tally.findings[:3])
    assert not tally.findings, "\n".join([*tally.lines(), shown])


@pytest.fixture(scope="module")
def runtimes() -> list[Runtime]:
    """Every target that is here."""
    found = [name for name in TARGETS if not isinstance(probe(name), TargetUnavailable)]
    if not found:
        pytest.skip("no target is here")
    return [open_runtime(name) for name in found]


@pytest.mark.parametrize("part", range(PARTS))
def test_random_programs_are_right(part: int, runtimes: list[Runtime]) -> None:
    numbers = range(part * COUNT // PARTS, (part + 1) * COUNT // PARTS)
    few = len(numbers) // SLOW_SHARE
    tally = Tally()
    run_cases(numbers[:few], SEED, runtimes, tally)
    run_cases(numbers[few:], SEED, [r for r in runtimes if r.device.target not in SLOW], tally)
    print("\n".join(tally.lines()))
    assert_none(tally, runtimes)


@pytest.mark.nightly
@pytest.mark.spreads
@pytest.mark.timeout(6 * 3600)
def test_many_random_programs_are_right(runtimes: list[Runtime]) -> None:
    """On two processes, since a compiler that panics ends the one in which it runs."""
    targets = [r.device.target for r in runtimes]
    few = NIGHTLY // SLOW_SHARE
    jobs = pieces(SEED + 1, 0, few, targets)
    if quick := [t for t in targets if t not in SLOW]:
        jobs += pieces(SEED + 1, few, NIGHTLY - few, quick)
    tally = run_jobs(Processes(2), jobs)
    print("\n".join(tally.lines()))
    assert_none(tally, runtimes)


def test_jobs_find_what_one_run_finds(runtimes: list[Runtime]) -> None:
    runtime = runtimes[0]
    tally = Tally()
    run_cases(range(300, 330), SEED, [runtime], tally)
    jobs = [Job(TASK, "", runtime.device.target, k, k + 10, seed=SEED) for k in range(300, 330, 10)]
    assert run_jobs(Here(), jobs) == tally
    made = pieces(SEED, 5, 450, ["glsl", "wgsl"])
    assert [(job.start, job.stop) for job in made] == [(5, 205), (205, 405), (405, 455)]
    assert {job.targets for job in made} == {("glsl", "wgsl")}


def test_a_program_that_ends_its_process_is_found() -> None:
    """Program 7 kills whoever runs it on the target b."""

    class Fragile:
        def run(self, jobs: Iterable[Job]) -> Iterator[Result]:
            for job in jobs:
                fatal = job.start <= 7 < job.stop and "b" in job.targets
                none = {"programs": job.stop - job.start, "findings": []}
                counts: dict[str, Any] = {name: {} for name in COUNTS}
                yield Result(job, {} if fatal else {**none, **counts}, "it died" if fatal else "")

    tally = run_jobs(Fragile(), [Job(TASK, "", "a,b", 0, 10, seed=SEED), Job(TASK, "", "a,b", 10, 20)])
    (found,) = tally.findings
    assert (found.case.number, found.kind, found.backend, found.detail) == (7, ENDED, "b", "it died")


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
    runtimes: list[Runtime],
) -> None:
    runtime = runtimes[0]  # the printer is shared
    damage(monkeypatch)
    found = reduced(first_value_finding([runtime]), runtime, tmp_path)
    assert found.nodes <= SMALL, functions_text(found.functions)


class BadDevice:
    """A device that stores 2.0 everywhere."""

    half_arithmetic = False

    def __init__(self, device: Any) -> None:
        self.device = device

    def run(self, program: str, words: Words, slots_out: int, textures: Sequence[TextureData] = ()) -> Words:
        return np.full((slots_out, words.shape[1]), 0x40000000, np.uint32)


def test_a_broken_device_is_found_and_reduced(tmp_path: Path, runtimes: list[Runtime]) -> None:
    bad = BadDevice(runtimes[0].device)
    found = reduced(first_value_finding([bad]), bad, tmp_path)
    assert found.nodes <= 2, functions_text(found.functions)


def test_findings_are_told_with_their_replay(runtimes: list[Runtime]) -> None:
    bad = BadDevice(runtimes[0].device)
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


def test_programs_hold_loops_that_a_parameter_ends() -> None:
    """Of both types; some bodies use the index."""
    ended, used = {"i32": 0, "u32": 0}, 0
    for number in range(300):
        for function in ast.walk(ast.parse(make_case(SEED, number).text)):
            if not isinstance(function, ast.FunctionDef):
                continue
            stated = {a.arg: ast.unparse(a.annotation or a) for a in function.args.args}
            for loop in ast.walk(function):
                head = ast.unparse(loop.iter) if isinstance(loop, ast.For) else ""
                limit = re.match(r"range\(min\((\w+),", head)
                if limit is None or not isinstance(loop, ast.For):
                    continue
                ended["i32" if "i32" in stated[limit[1]] else "u32"] += 1
                index = ast.unparse(loop.target)
                used += any(isinstance(n, ast.Name) and n.id == index for s in loop.body for n in ast.walk(s))
    assert min(*ended.values(), used) >= 3, (ended, used)


def test_an_invalid_program_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*args: object) -> None:
        raise UserError("no")

    monkeypatch.setattr("conformance.fuzz.engine.verify_selection", refuse)
    tally = Tally()
    run_cases(range(1), SEED, [], tally)
    assert [f.signature for f in tally.findings] == [("refused", "front end")]


def test_products_that_wrap_are_permitted(tmp_path: Path) -> None:
    """Found by program 35 of seed 1: an interval of products beyond 2^52 was taken for the single word 0."""
    text = "def case_0(x: f32_range) -> u32:\n    h = float_to_bits(x)\n    return h * h * (h * 65535)\n"
    text = text.replace("f32_range", "Annotated[f32, Interval(-4.0, 4.0)]")
    library = write(tmp_path, [Case(SEED, 0, text, "case_0")])
    inputs = {"x": np.array([0.0, 1.5, -3.0, 0.7], np.float32)}
    got = evaluate(library, "case_0", inputs)
    assert judge.intervals(library, "case_0", inputs, "glsl").contains(got).all()
