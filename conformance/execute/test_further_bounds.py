"""Functions keep the bounds of further_bounds.toml, on every target and in the evaluator.

Plan. The points of test_functions.py; every further bound holds, and some input lies inside it.
"""

import pytest

from codegen.library import Library, default_root
from conformance.check.engine import backend, check_function
from conformance.execute.further import further_bounds, with_further_bounds


def judge(name: str, target: str) -> None:
    library = with_further_bounds(Library(default_root()))
    result = check_function(library, name, backend(target), intervals=False)
    assert result.passed, "\n".join(line for f in result.failures for line in f.lines())
    further = result.bounds[-len(further_bounds()[name]) :]
    assert all(bound.lanes > 300 for bound in further)


@pytest.mark.parametrize("name", further_bounds())
def test_function_keeps_its_further_bounds(target: str, name: str) -> None:
    judge(name, target)


@pytest.mark.parametrize("name", further_bounds())
def test_evaluator_keeps_the_further_bounds(name: str) -> None:
    judge(name, "numpy")
