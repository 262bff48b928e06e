"""Every public function on every target, and in the evaluator, under both verdicts of `vair check`.

Plan. For each function, on all targets that are here and in the evaluator:
  permitted   each result in the interval that the target's accuracy table allows; known failures of drivers
              stand in conformance/drivers/known_failures.toml
  values      random points of the stated domain and every family of hard cases that fits its parameters, each
              result against the independent reference, under the declared bounds of shaderlib/*/bounds.toml
  finiteness  every input, also where no bound applies
  coverage    the function declares a bound and has a reference, and its bounds apply to some input
The inputs, references and intervals of a function are computed once for all backends: one test each.
Not covered here: speed (conformance.bench), pictures (conformance.picture).
"""

from __future__ import annotations

from datetime import date

import pytest

from codegen.library import load_library
from conformance.check.backend import Backend, backend
from conformance.check.draws import draws
from conformance.check.engine import check_function
from conformance.check.prepared import prepare
from conformance.check.report import lines
from conformance.conftest import available_targets
from conformance.drivers import known
from conformance.drivers.modes import DEFAULT

FUNCTIONS = list(load_library().public)
UNIFORM, FAMILY = 4_000, 500
"""Random points, and most points of a family: a share of what `vair check` draws, to keep the suite quick."""


@pytest.fixture(scope="session")
def backends() -> list[Backend]:
    """Every target that is here, and the evaluator."""
    return [backend(name) for name in (*available_targets(), "numpy")]


def test_target_is_here(target: str) -> None:
    """A missing target is skipped here, once and by name, and left out below."""
    assert target in available_targets()


@pytest.mark.parametrize("name", FUNCTIONS)
def test_function_is_permitted_and_within_its_bounds(name: str, backends: list[Backend]) -> None:
    library = load_library()
    ready = prepare(library, name, draws(library.function(name), UNIFORM, FAMILY))
    results = [check_function(library, name, on, prepared=ready) for on in backends]
    runs = [
        known.Judged(driver, DEFAULT, [result], whole=False)
        for on, result in zip(backends, results, strict=True)
        if (driver := known.name_of(on.device))
    ]
    complaints = known.judge(runs, known.read(), date.today()).complaints
    if complaints or not all(r.accepted for r in results):
        pytest.fail("\n".join([*complaints, *lines(results, details=False)]), pytrace=False)
    for result in results:
        assert any(bound.lanes for bound in result.bounds), f"no input lies inside a bound of {name}"
