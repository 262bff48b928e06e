"""Specialised functions compute what the general ones compute, for every public function.

Plan. Each function is specialised to a random choice of what may be known: some parameters constant (drawn
from its own inputs), some equal to others of the same type and domain, some in a narrower range; by the exact
passes only. On inputs that agree with the choice, the specialised function's float32 and float64 results are
permitted results of the general one under the WGSL table, which bounds every rounding either way; and it
verifies. Without any knowledge, both agree bit for bit in float32 where no range or identity had its say, and
in float64 always. By default a sample with one choice each, nightly all with several.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from zlib import crc32

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.intervals import permitted
from codegen.ir.domains import Interval
from codegen.ir.types import F32, Struct, Type
from codegen.ir.verify import verify
from codegen.library import load_library
from codegen.passes.specialise import Specialised, specialise
from codegen.passes.subject import Subject
from conformance.cases.drawing import draw
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


class Choice:
    """What is known of a function's parameters, at random."""

    def __init__(self, name: str, number: int) -> None:
        self.name = name
        self.random = np.random.default_rng([SEED, crc32(name.encode()), number])
        function = LIBRARY.function(name)
        self.inputs = draw(function, "uniform", LANES, SEED + number)
        subject = Subject(function)
        self.constants: dict[str, Any] = {}
        self.aliases: dict[str, str] = {}
        self.ranges: dict[str, tuple[float, float]] = {}
        free = [p for p, t in subject.types.items() if not isinstance(t, Struct) and self.is_free(p)]
        for path in free:
            type_, domain = subject.types[path], subject.domains[path]
            self.choose(
                path,
                type_,
                domain,
                [p for p in free if (subject.types[p], subject.domains[p]) == (type_, domain)],
            )

    def is_free(self, path: str) -> bool:
        return path.rpartition(".")[2] not in FRAME

    def choose(self, path: str, type_: Type, domain: object, alike: list[str]) -> None:
        way = self.random.integers(0, 6)
        lane = int(self.random.integers(0, LANES))
        others = [p for p in alike if p != path and p not in self.aliases and p not in self.aliases.values()]
        if path in self.aliases.values() or path in self.aliases:
            return
        if way in (0, 1):
            self.constants[path] = np.asarray(get(self.inputs, path))[lane].tolist()
        elif way == 2 and others:
            self.aliases[path] = others[int(self.random.integers(0, len(others)))]
        elif way == 3 and isinstance(domain, Interval) and type_ == F32:
            values = np.sort(np.asarray(get(self.inputs, path), np.float64)[[lane, LANES - 1 - lane]])
            low, high = max(float(values[0]), domain.low), min(float(values[1]), domain.high)
            if low <= high:
                self.ranges[path] = low, high

    def __str__(self) -> str:
        return f"{self.name}: constants {self.constants}, aliases {self.aliases}, ranges {self.ranges}"

    def specialised(self) -> Specialised:
        for path in [p for p, target in self.aliases.items() if target in self.constants]:
            self.constants.pop(path, None)
        for target in set(self.aliases.values()):
            self.ranges.pop(target, None)
        return specialise(
            LIBRARY, self.name, self.constants, self.aliases, self.ranges, new_name="probe_specialised"
        )

    def agreeing(self, made: Specialised) -> dict[str, Any]:
        """The inputs with everything as it was chosen."""
        for path, (low, high) in self.ranges.items():
            *outer, last = path.split(".")
            place: Any = self.inputs
            for key in outer:
                place = place[key]
            place[last] = np.clip(place[last], np.float32(low), np.float32(high))
        return made.impose(self.inputs)


def get(inputs: Mapping[str, Any], path: str) -> Any:
    value: Any = inputs
    for key in path.split("."):
        value = value[key]
    return value


def check(name: str, number: int) -> None:
    choice = Choice(name, number)
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


def repeated(value: Any, count: int) -> Any:
    if isinstance(value, dict):
        return {key: repeated(part, count) for key, part in value.items()}
    return np.repeat(value, count // len(value), axis=0)


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
    made = specialise(LIBRARY, name, new_name="probe_specialised")
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
