"""Results stay where the sources promise, without tolerance (codomains.toml), on every target.

Plan. Random points and every family of hard cases of each function.
Not covered here: accuracy (test_functions).
"""

from __future__ import annotations

import pytest

from codegen.library import load_library
from conformance.check.engine import backend, draws
from conformance.execute.further import codomains, leaves_codomain


def judge(name: str, target: str) -> None:
    on = backend(target)
    for d in draws(load_library().function(name)):
        assert not leaves_codomain(name, on.run(load_library(), name, d.inputs)), d.family


@pytest.mark.parametrize("name", codomains())
def test_results_stay_inside(target: str, name: str) -> None:
    judge(name, target)


@pytest.mark.parametrize("name", codomains())
def test_evaluator_stays_inside(name: str) -> None:
    judge(name, "numpy")
