"""Every public function on every target, and in the evaluator.

Plan. For each function and target:
  values      random points of the stated domain and every family of hard cases that fits its parameters, each
              result against the independent reference, under the declared bounds of shaderlib/*/bounds.toml
  finiteness  every input, also where no bound applies
  coverage    the function declares a bound and has a reference, and its bounds apply to some input
Not covered here: speed (conformance.bench), pictures (conformance.picture).
"""

from __future__ import annotations

import pytest

from codegen.library import load_library
from conformance.check.engine import Backend, backend, check_function, draws

FUNCTIONS = list(load_library().public)
UNIFORM, FAMILY = 4_000, 500
"""Random points, and most points of a family: a share of what `vair check` draws, to keep the suite quick."""


def judge(name: str, on: Backend) -> None:
    library = load_library()
    drawn = draws(library.function(name), UNIFORM, FAMILY)
    result = check_function(library, name, on, drawn)
    if not result.passed:
        told = [result.broken, *("\n".join(f.lines()) for f in result.failures)]
        pytest.fail("\n\n".join(filter(None, told)), pytrace=False)
    assert any(bound.lanes for bound in result.bounds), f"no input lies inside a bound of {name}"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_function_keeps_its_bounds(target: str, name: str) -> None:
    judge(name, backend(target))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_evaluator_keeps_the_bounds(name: str) -> None:
    judge(name, backend("numpy"))
