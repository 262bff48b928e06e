"""Random programs mean the same to the front end, the evaluator, Python and specialisation.

Plan.
  meaning      programs with structs, helpers, branches, loops and every built-in: the evaluator's results and
               those of Python executing the source lie in the interval that an accuracy table permits
  specialised  the same programs made for random constants, equal parameters and ranges, loops kept or
               unrolled, helpers followed or kept: results stay permitted ones of the general program
What devices make of such programs: execute/test_fuzz.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import permitted
from codegen.ir import nodes as ir
from codegen.ir.verify import verify_selection
from codegen.library import Library
from conformance.fuzz import python_oracle
from conformance.fuzz.case import Case, draw_inputs, make_case
from conformance.fuzz.engine import Tally, run_cases
from conformance.fuzz.report import explain
from conformance.fuzz.source import write
from conformance.unit.support.knowledge import NAME, Choice, repeated

SEED = 31
COUNT, PARTS = 160, 4
"""Programs, and the tests that share them."""
LANES = 24
TABLE = "wgsl"
"""Bounds every rounding either way."""


all_parts = pytest.mark.parametrize(
    "part", [0, *(pytest.param(part, marks=pytest.mark.nightly) for part in range(1, PARTS))]
)


def part_of(part: int) -> range:
    return range(part * COUNT // PARTS, (part + 1) * COUNT // PARTS)


def library_of_programs(folder: Path, part: int) -> tuple[Library, dict[str, dict[str, Any]]]:
    """Programs and inputs for each."""
    cases = [make_case(SEED, number) for number in part_of(part)]
    library = write(folder, cases)
    return library, {c.entry: draw_inputs(c, library.function(c.entry).parameters, LANES) for c in cases}


@all_parts
def test_programs_mean_what_they_say(part: int) -> None:
    tally = Tally()
    run_cases(part_of(part), SEED, [], tally)
    shown = "\n\n".join(explain(finding, []) for finding in tally.findings[:3])
    assert not tally.findings, "\n".join([*tally.lines(), shown])
    assert tally.programs == len(part_of(part))


NO_NUMBER = """def case_0(x: Annotated[f32, Interval(-4.0, 4.0)]) -> {type}:
    y = x * 1.0e20 * 1.0e20
    return {type}(clamp(y - y, 0.0, 99.0))
"""


@pytest.mark.parametrize("type_", ["i32", "u32"])
def test_python_converts_what_is_no_number(type_: str, tmp_path: Path) -> None:
    """Random program 17175 of seed 1: no table promises anything, and every other lane is judged."""
    case = Case(SEED, 0, NO_NUMBER.format(type=type_), "case_0")
    library = write(tmp_path, [case])
    inputs = {"x": np.array([3.0, 0.0], np.float32)}
    allowed = permitted(library, case.entry, inputs, TABLE)
    got = python_oracle.run(case.text, library.function(case.entry), inputs, range(2))
    assert allowed.guaranteed.tolist() == [False, True]
    assert allowed.contains(got).all()
    assert np.asarray(got)[1] == 0


@all_parts
def test_specialised_programs_compute_what_they_did(part: int, tmp_path: Path) -> None:
    library, inputs = library_of_programs(tmp_path, part)
    for number, (name, given) in enumerate(inputs.items()):
        random = np.random.default_rng([SEED, part, number])
        choice = Choice(library, name, given, random)
        helpers = [c for c in ir.callees(library.function(name)) if random.integers(0, 2)]
        made = choice.specialised(keep=helpers, unroll=int(random.choice((0, 3, 8))))
        extended = library.with_functions([made.function])
        verify_selection(extended.select([NAME]).functions)
        agreeing = choice.agreeing(made)
        allowed = permitted(library, name, agreeing, TABLE)
        got = evaluate(extended, NAME, made.arguments(agreeing))
        if not made.parameters:
            got = repeated(got, LANES)
        inside = allowed.contains(got)
        assert inside.all(), f"{choice}: seed {SEED}, lane {int(np.argmin(inside))}"
