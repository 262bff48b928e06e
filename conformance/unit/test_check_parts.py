"""Functions that public ones do not show agree with their formulas; none that nobody calls is forgotten."""

from __future__ import annotations

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.ir.nodes import callees
from codegen.library import load_library
from conformance.check.draws import draw
from conformance.check.parts import ALONE, COUNT, PARTS, SEED, passes


def test_every_function_is_public_or_called_or_a_part() -> None:
    library = load_library()
    reached = {name for f in library.functions.values() for name in callees(f)}
    alone = {name for name, f in library.functions.items() if not f.public and name not in reached}
    assert alone == set(ALONE)


@pytest.mark.parametrize("name", PARTS)
def test_part_agrees_with_its_formula(name: str) -> None:
    assert passes(load_library(), name)


@pytest.mark.parametrize("name", PARTS)
def test_formula_says_something(name: str) -> None:
    library = load_library()
    inputs = draw(library.function(name), "uniform", COUNT, SEED).inputs
    wanted = PARTS[name](inputs)
    assert np.isfinite(wanted).mean() > 0.9
    assert len(np.unique(np.asarray(evaluate(library, name, inputs)))) > 1
