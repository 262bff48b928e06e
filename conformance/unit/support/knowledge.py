"""What is known of a function's parameters, chosen at random, and inputs that agree with it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from codegen.ir.domains import Interval
from codegen.ir.types import F32, Array, Struct, Type
from codegen.library import Library
from codegen.passes.specialise import Specialised, specialise
from codegen.passes.subject import Subject

NAME = "probe_specialised"
"""Name of every function that is made."""


class Choice:
    """Some parameters constant, some equal to others of their type and domain, some in a narrower range."""

    def __init__(
        self,
        library: Library,
        name: str,
        inputs: dict[str, Any],
        random: np.random.Generator,
        fixed: Collection[str] = (),
    ) -> None:
        """`fixed`: last parts of the paths that are not free, because they depend on each other."""
        self.library, self.name, self.inputs, self.random = library, name, inputs, random
        subject = Subject(library.function(name))
        self.constants: dict[str, Any] = {}
        self.aliases: dict[str, str] = {}
        self.ranges: dict[str, tuple[float, float]] = {}
        free = [
            path
            for path, type_ in subject.types.items()
            if (not isinstance(type_, Struct) or isinstance(type_, Array))
            and path.rpartition(".")[2] not in fixed
        ]
        for path in free:
            kind = subject.types[path], subject.domains[path]
            self._choose(path, *kind, [p for p in free if (subject.types[p], subject.domains[p]) == kind])

    def _choose(self, path: str, type_: Type, domain: object, alike: list[str]) -> None:
        way = self.random.integers(0, 6)
        values = get(self.inputs, path)
        count = len(next(iter(values.values())) if isinstance(values, dict) else values)
        lane = int(self.random.integers(0, count))
        others = [p for p in alike if p != path and p not in self.aliases and p not in self.aliases.values()]
        if path in self.aliases.values() or path in self.aliases:
            return
        if way in (0, 1) and not isinstance(values, dict):
            self.constants[path] = np.asarray(values)[lane].tolist()
        elif way == 2 and others:
            self.aliases[path] = others[int(self.random.integers(0, len(others)))]
        elif way == 3 and isinstance(domain, Interval) and type_ == F32:
            two = np.sort(np.asarray(values, np.float64)[[lane, count - 1 - lane]])
            low, high = max(float(two[0]), domain.low), min(float(two[1]), domain.high)
            if low <= high:
                self.ranges[path] = low, high

    def __str__(self) -> str:
        return f"{self.name}: constants {self.constants}, aliases {self.aliases}, ranges {self.ranges}"

    def specialised(self, **how: Any) -> Specialised:
        """The function made for what is known."""
        for path in [p for p, target in self.aliases.items() if target in self.constants]:
            self.constants.pop(path, None)
        for target in set(self.aliases.values()):
            self.ranges.pop(target, None)
        known = self.constants, self.aliases, self.ranges
        return specialise(self.library, self.name, *known, new_name=NAME, **how)

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
    """The inputs of a path."""
    value: Any = inputs
    for key in path.split("."):
        value = value[key]
    return value


def repeated(value: Any, count: int) -> Any:
    """One lane's value for all lanes."""
    if isinstance(value, dict):
        return {key: repeated(part, count) for key, part in value.items()}
    return np.repeat(value, count // len(value), axis=0)
