"""Programs and inputs that must agree do agree on every target.

Plan. A pair is two calls whose results are related by arithmetic, not by a reference.
  inputs     l and v exchanged, directions reversed, turned and mirrored, powers of two, colours permuted:
             conformance/metamorphic/relations.toml names the functions
  programs   a function and its rewriting: + 0 and * 1 read at run time, calls inlined or not, loops split,
             vectors by component, literals read at run time, statements and operands in another order, parts
             named or written out, branches exchanged, guarded or made of conditional expressions; subjects
             are library functions and random programs, which have loops
Each result must lie in its own interval, both within the width of their intervals' union, intervals of one
real number must meet, and both sides must mean the same in float64. Unbounded pairs are counted, not failed,
and so are results that only a rearrangement of sums explains. A damaged rewriting is found.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.ir.verify import verify_selection
from codegen.library import Library, load_library
from conformance.executor import Here, Processes, Result
from conformance.executor.state import State
from conformance.fuzz.choices import Choice
from conformance.metamorphic import inputs, source
from conformance.metamorphic.__main__ import LANES as NIGHTLY_LANES
from conformance.metamorphic.__main__ import RESULTS, STATE
from conformance.metamorphic.engine import Report, run_pairs
from conformance.metamorphic.pairs import Pair, draw, input_pair, source_pair
from conformance.metamorphic.plan import input_pairs, library_pairs, program_pairs, random_programs
from conformance.metamorphic.relation import Changed, SourceRelation
from conformance.metamorphic.source.tools import changed_body
from conformance.metamorphic.task import PROGRAMS, pieces, run_jobs
from targets import TARGETS, TargetUnavailable, TimedRuntime, probe

LIBRARY = load_library()
LANES = 32
EACH = 2
"""Functions and programs for each relation in a normal run."""
FORMED = 5
"""Functions for each relation whose rewriting is only verified, not run."""
FEW_PROGRAMS = 30
LEAST_RELATIONS = 12
LEAST_NIGHTLY = 100_000


def check(library: Library, pairs: Iterable[Pair], runtime: TimedRuntime, lanes: int) -> Report:
    report = run_pairs(library, pairs, [runtime], lanes)
    table = "\n".join(report.lines())
    print(table)
    assert not report.failures, "\n".join([table, *report.failures[:5]])
    return report


def test_related_inputs_agree(runtime: TimedRuntime) -> None:
    report = check(LIBRARY, input_pairs(LIBRARY, LANES, EACH), runtime, LANES)
    assert set(report.counts) == {r.name for r in inputs.RELATIONS}


def test_rewritten_functions_agree(runtime: TimedRuntime) -> None:
    check(LIBRARY, library_pairs(LIBRARY, LANES, EACH), runtime, LANES)


def test_rewritten_programs_agree(runtime: TimedRuntime, tmp_path: Path) -> None:
    library, cases = random_programs(tmp_path, FEW_PROGRAMS)
    report = check(library, program_pairs(library, cases, LANES, EACH), runtime, LANES)
    assert len(report.counts) >= LEAST_RELATIONS


def targets_here() -> list[str]:
    found = [name for name in TARGETS if not isinstance(probe(name), TargetUnavailable)]
    if not found:
        pytest.skip("no target is here")
    return found


def test_jobs_run_every_kind_of_pair(tmp_path: Path) -> None:
    """On one target; what is done once is not done again."""
    few = 8
    whole = pieces(LIBRARY, targets_here()[:1], few)
    kinds = {
        "inputs": inputs.RELATIONS[0].name,
        "library": source.RELATIONS[0].name,
        "programs": source.RELATIONS[1].name,
    }
    jobs = [
        replace(next(job for job in whole if job.function == f"{kind}/{name}"), stop=3)
        for kind, name in kinds.items()
    ]
    report, undone = run_jobs(Here(), jobs, State(tmp_path / "state.jsonl"))
    assert not undone
    assert not report.failures
    assert set(report.counts) == set(kinds.values())
    assert all(count.pairs in (few, 2 * few, 3 * few) for count in report.counts.values())
    again, undone = run_jobs(Here(), jobs, State(tmp_path / "state.jsonl"), never_asked)
    assert again == report


def never_asked(result: Result) -> None:
    assert result.data["counts"], "done before, so told with its data"


def test_jobs_hold_every_subject_once() -> None:
    told: dict[tuple[str, str], list[int]] = {}
    for job in pieces(LIBRARY, ["glsl", "wgsl"], 8):
        told.setdefault((job.target, job.function), []).extend(range(job.start, job.stop))
    assert len(told) == 2 * (len(inputs.RELATIONS) + 2 * len(source.RELATIONS))
    assert {target for target, _ in told} == {"glsl", "wgsl"}
    for (_, what), found in told.items():
        kind, name = what.split("/")
        related = {r.name: len(r.functions) for r in inputs.RELATIONS}
        count = {"inputs": related.get(name, 0), "library": len(LIBRARY.public), "programs": PROGRAMS}[kind]
        assert found == list(range(count)), what


def test_a_job_that_is_not_done_is_told() -> None:
    (job,) = [job for job in pieces(LIBRARY, ["metal"], 8) if job.function == "inputs/quarter_turn"]
    report, undone = run_jobs(Here(), [job])
    assert undone == [f"{job.identity}: there is no target metal"]
    assert not report.counts


@pytest.mark.nightly
@pytest.mark.spreads
@pytest.mark.timeout(2 * 3600)
def test_all_related_pairs_agree() -> None:
    """On two processes."""
    jobs = pieces(LIBRARY, targets_here(), NIGHTLY_LANES)
    report, undone = run_jobs(Processes(2), jobs, State(STATE))
    print("\n".join(report.lines()))
    assert not undone
    assert not report.failures, "\n".join(report.failures[:5])
    assert report.pairs >= LEAST_NIGHTLY


def test_what_is_recorded_agrees() -> None:
    if not RESULTS.exists():
        pytest.skip("python -m conformance.metamorphic writes it")
    recorded = json.loads(RESULTS.read_text(encoding="utf-8"))
    assert not recorded["failures"]
    assert recorded["pairs"] >= LEAST_NIGHTLY
    names = {r.name for r in inputs.RELATIONS} | {r.name for r in source.RELATIONS}
    assert set(recorded["relations"]) == names


def test_every_rewriting_makes_well_formed_programs(tmp_path: Path) -> None:
    library, cases = random_programs(tmp_path, FEW_PROGRAMS)
    pairs = [*library_pairs(LIBRARY, 4, FORMED), *program_pairs(library, cases, 4, None)]
    for pair in pairs:
        base = library if pair.subject.startswith("case_") else LIBRARY
        extended = base.with_functions(pair.added)
        verify_selection(extended.select([pair.second.name]).functions)
    assert {p.relation for p in pairs} == {r.name for r in source.RELATIONS}


def test_opposite_light_and_viewer_are_left_out_of_turns(runtime: TimedRuntime) -> None:
    """There half_vector falls back on an axis, which turns with nothing."""
    (relation,) = [r for r in inputs.RELATIONS if r.name == "quarter_turn"]
    function = LIBRARY.function("scheuermann_shade")
    drawn = draw(function, LANES, 1)
    drawn["v"][LANES // 2 :] = -drawn["l"][LANES // 2 :]
    pair = input_pair(relation, function, drawn)
    assert np.array_equal(pair.first.inputs["v"][: LANES // 2], drawn["v"][: LANES // 2])
    assert not run_pairs(LIBRARY, [pair], [runtime], LANES).failures
    careless = replace(relation, silent=None)
    assert run_pairs(LIBRARY, [input_pair(careless, function, drawn)], [runtime], LANES).failures


def damaged(function: ir.Function, library: Library, choice: Choice) -> Changed | None:
    """A 'rewriting' that forgets a product's first factor."""
    changed = changed_body(function, lambda e: e.right if isinstance(e, ir.Binary) and e.op == "*" else e)
    return None if changed is None else Changed(changed)


def test_a_wrong_rewriting_is_found(runtime: TimedRuntime) -> None:
    relation = SourceRelation("damaged", "drops a factor", damaged)
    function = LIBRARY.function("coat_transmittance")
    pair = source_pair(relation, function, LIBRARY, partial(draw, function, LANES, 1), LANES)
    assert pair is not None
    assert function.returns == F32
    failures = run_pairs(LIBRARY, [pair], [runtime], LANES).failures
    assert any("mean different numbers" in f for f in failures)
    assert any("do not meet" in f for f in failures)
