"""Specialised functions compute what the general ones compute, for every public function.

Plan. Each function is specialised to a random choice of what may be known: some parameters constant (drawn
from its own inputs), some equal to others of the same type and domain, some in a narrower range; by the exact
passes only. On inputs that agree with the choice, the specialised function's float32 and float64 results are
permitted results of the general one under the WGSL table, which bounds every rounding either way; and it
verifies. Without any knowledge, both agree bit for bit in float32 where no range or identity had its say, and
in float64 always. By default a sample with one choice each, nightly all with several.
"""

from __future__ import annotations

from typing import Any
from zlib import crc32

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import permitted
from codegen.ir.verify import verify
from codegen.library import load_library
from codegen.passes.specialise import specialise
from conformance.cases.drawing import draw
from conformance.unit.support.knowledge import NAME, Choice, repeated
from conformance.unit.support.trees import no_function

LIBRARY = load_library()
NAMES = sorted(LIBRARY.public)
SAMPLE = sorted({"fakefur_shade", "kajiya_kay_shade", "shell_shade", "scheuermann_shade", *NAMES[3::12]})
LANES = 300
SEED = 20261122
CHOICES = 6
TABLE = "wgsl"
FRAME = {"tangent", "bitangent", "normal"}
"""Fields of a frame, which are not free."""

DOUBLE = 2.0**-44
"""Relative distance in float64 that sums in another form may have, at most 2^8 ULP of the largest term."""


def choice_of(name: str, number: int) -> Choice:
    """What is known of a library function's parameters."""
    inputs = draw(LIBRARY.function(name), "uniform", LANES, SEED + number)
    random = np.random.default_rng([SEED, crc32(name.encode()), number])
    return Choice(LIBRARY, name, inputs, random, FRAME)


def check(name: str, number: int) -> None:
    choice = choice_of(name, number)
    made = choice.specialised()
    verify(made.function, no_function)
    inputs = choice.agreeing(made)
    extended = LIBRARY.with_functions([made.function])
    allowed = permitted(LIBRARY, name, inputs, TABLE)
    for arithmetic in ("float32", "float64"):
        got = evaluate(extended, made.function.name, made.arguments(inputs), arithmetic)
        if made.parameters == {}:
            got = repeated(got, len(allowed.codes))
        inside = allowed.contains(got)
        assert inside.all(), f"{choice}: {arithmetic}, lane {int(np.argmin(inside))}"


@pytest.mark.parametrize("name", SAMPLE)
def test_specialised_results_are_permitted_ones(name: str) -> None:
    check(name, 0)


@pytest.mark.nightly
@pytest.mark.parametrize("number", range(1, 1 + CHOICES))
@pytest.mark.parametrize("name", NAMES)
def test_specialised_results_are_permitted_ones_of_every_function(name: str, number: int) -> None:
    check(name, number)


def columns(value: Any) -> list[np.ndarray]:
    if isinstance(value, dict):
        return [column for part in value.values() for column in columns(part)]
    return list(np.asarray(value, np.float64).reshape(len(value), -1).T)


def compare_without_knowledge(name: str) -> None:
    made = specialise(LIBRARY, name, new_name=NAME)
    verify(made.function, no_function)
    inputs = draw(LIBRARY.function(name), "uniform", LANES, SEED)
    extended = LIBRARY.with_functions([made.function])
    general = columns(evaluate(LIBRARY, name, inputs, "float64"))
    special = columns(evaluate(extended, made.function.name, made.arguments(inputs), "float64"))
    for a, b in zip(general, special, strict=True):
        np.testing.assert_allclose(b, a, rtol=DOUBLE, atol=0.0, err_msg=name)


@pytest.mark.parametrize("name", SAMPLE)
def test_nothing_known_changes_nothing(name: str) -> None:
    compare_without_knowledge(name)


@pytest.mark.nightly
@pytest.mark.parametrize("name", NAMES)
def test_nothing_known_changes_no_function(name: str) -> None:
    compare_without_knowledge(name)
