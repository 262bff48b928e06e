"""The peers' forms run on every target, fail where they are known to, and ours do not.

Plan.
  library   every form is a variant of the function that PEERS names, and no part of the emitted library
  failures  each row of known_failures.toml shows up on every target and in the evaluator; on the same inputs
            the function of ours is within its bounds
  answers   the tests that README.md names are there
  sources   an extra folder is a section of its own; a folder that is not there is refused
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.bounds import Bound
from codegen.errors import UserError
from codegen.library import load_library
from conformance import peers
from conformance.bench.inputs import within
from conformance.check import measure
from conformance.check.backend import Backend, backend
from conformance.check.draws import draws
from conformance.check.engine import check_function, expected_of
from conformance.check.features import applies
from conformance.reference import ambiguous, reference_for

ROWS: dict[str, list[dict[str, Any]]] = tomllib.loads(
    (Path(peers.__file__).parent / "known_failures.toml").read_text(encoding="utf-8")
)
UNIFORM, FAMILY = 4_000, 500


def test_every_form_names_what_it_competes_with() -> None:
    library = peers.library()
    found = {name: f.base for name, f in library.public.items() if f.module == peers.FORMS.name}
    assert found == peers.PEERS
    assert set(ROWS) == set(peers.PEERS)
    assert all(f.kind == "variant" for f in map(library.function, peers.PEERS))


def test_named_answers_are_there() -> None:
    text = (peers.FORMS.parent / "README.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| ") and "::" in line]
    named = [re.findall(r"`([\w/]+\.py)::(test_\w+)`", row) for row in rows]
    assert len(rows) > 10 and all(named)
    for file, name in {pair for pairs in named for pair in pairs}:
        path = peers.FORMS.parents[1] / file
        assert path.is_file() and f"\ndef {name}(" in path.read_text(encoding="utf-8"), f"{file}::{name}"


def test_forms_are_no_part_of_the_emitted_library() -> None:
    assert not set(peers.PEERS) & set(load_library().public)


def test_a_missing_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no shader sources"):
        load_library(extra=(tmp_path / "nowhere",))


def shows_its_failures(name: str, on: Backend) -> None:
    library = peers.library()
    base = peers.PEERS[name]
    for row in ROWS[name]:
        bound = Bound(name, row["measure"], row["at_least"], "", "", row.get("floor", 0.0), row["where"])
        inside, _ = within(library.function(base), [bound])
        drawn = list(draws(inside, UNIFORM, FAMILY))
        worst, wrong = 0.0, 0
        for d in drawn:
            got = on.run(library, name, d.inputs)
            finite = measure.finite(got)
            wrong += int((~finite).sum())
            chosen = applies(bound, d.inputs, d.count) & finite & ~ambiguous(base, d.inputs)
            if chosen.any():
                error = measure.error(bound, got, expected_of(reference_for(base), d.inputs))
                worst = max(worst, float(np.max(error[chosen])))
        assert worst >= row["at_least"], f"{name}: {row['measure']} {worst:.3g}, known are {row['at_least']}"
        assert wrong > 0 or not row.get("not_finite")
        assert check_function(library, base, on, drawn).passed


@pytest.mark.parametrize("name", peers.PEERS)
def test_known_failures_show_on_the_target(target: str, name: str) -> None:
    shows_its_failures(name, backend(target))


@pytest.mark.parametrize("name", peers.PEERS)
def test_known_failures_show_in_the_evaluator(name: str) -> None:
    shows_its_failures(name, backend("numpy"))
