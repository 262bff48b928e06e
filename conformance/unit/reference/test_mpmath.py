"""Every float64 reference agrees with mpmath on its hard cases, ends of domains and uniform inputs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from conformance import cases
from conformance.reference import ambiguous, reference_for
from conformance.unit.reference.checks import CHECKS, bound
from conformance.unit.reference.multiprecision import FORMS
from conformance.unit.reference.signatures import FUNCTIONS

ROWS = 16
SEED = 7
SMALL_POWER = 0.02
LARGEST_COSINE = 1e-4
"""Above it a small power of a strand cosine magnifies nothing worth a look."""


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    with mp.workdps(CHECKS["mpmath"]["digits"]):
        yield


def exact(value: Any) -> Any:
    """A float64 number, vector or struct as mpf, without rounding."""
    if isinstance(value, dict):
        return {name: exact(field) for name, field in value.items()}
    return [mpf(float(x)) for x in value] if np.ndim(value) else mpf(float(value))


def row(inputs: Any, k: int) -> Any:
    """One row of inputs or of a result."""
    return {name: row(x, k) for name, x in inputs.items()} if isinstance(inputs, dict) else inputs[k]


def worst(name: str, got: Any, want: Any) -> float:
    """Largest error over fields and components, in the measure that the data names for this function."""
    if isinstance(want, dict):
        return max(worst(name, got[field], want[field]) for field in want)
    got, want = (x if isinstance(x, list) else [x] for x in (got, want))
    size = max(abs(x) for x in want)
    floor = CHECKS["mpmath"]["smallest"] if name in CHECKS["mpmath"]["relative"] else 1.0
    return float(max(abs(g - w) for g, w in zip(got, want, strict=True)) / max(size, mpf(floor)))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_agrees_with_mpmath(name: str) -> None:
    function = FUNCTIONS[name]
    for family in (cases.UNIFORM, *cases.families_for(function.parameters)):
        inputs = cases.draw(function, family, ROWS, SEED)
        got = reference_for(name)(*inputs.values())
        skipped = ambiguous(name, inputs)
        for k in np.flatnonzero(~skipped):
            arguments = [exact(row(x, int(k))) for x in inputs.values()]
            error = worst(name, exact(row(got, int(k))), FORMS[name](*arguments))
            assert error <= bound("mpmath"), f"{family}: {row(inputs, int(k))} is off by {error:.3g}"


def test_every_function_has_a_form() -> None:
    assert set(FORMS) == set(FUNCTIONS)


def test_small_powers_just_above_the_dark_side() -> None:
    """Strand cosines between 1e-6 and 1e-4, where a small power magnifies an error of 1e-16."""
    points = cases.load("dark_side_triples")
    exponent = np.full(len(points["t"]), SMALL_POWER, dtype=np.float32)
    inputs = {**points, "exponent": exponent}
    value = reference_for("strand_specular")(*inputs.values())
    close = np.flatnonzero(
        (value > 0.0) & (value < LARGEST_COSINE**SMALL_POWER) & ~ambiguous("strand_specular", inputs)
    )
    assert len(close) > ROWS
    for k in close:
        arguments = [exact(row(x, int(k))) for x in inputs.values()]
        want = FORMS["strand_specular"](*arguments)
        assert worst("strand_specular", exact(value[k]), want) <= bound("mpmath")
