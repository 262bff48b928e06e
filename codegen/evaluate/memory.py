"""A memory of evaluated expressions: functions that share most of their text share most of their work.

Values are the same object if and only if they came from the same expression over the same objects, so an
expression is known by itself and by the objects that its variables stand for, a call by the function's name
and its arguments. What is remembered keeps those objects alive. A memory serves one arithmetic and inputs
of one length, and functions that are called by one name have to be the same throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.evaluate.arrays import Arithmetic, Value, convert_inputs
from codegen.evaluate.pages import Pages
from codegen.ir import nodes as ir
from codegen.ir.content import variables, zeros

MOST = 256 * 2**20
"""Bytes of values that are remembered; then all are forgotten."""

Key = tuple[object, ...]
"""What a value is known by: the number of an expression, or the name of a function; lanes; and the ids of the
values that it is made of."""


@dataclass(frozen=True, slots=True)
class Prepared:
    """What asking for an expression takes: its number, its variables, and its calls that are in no other's
    arguments."""

    number: int
    variables: tuple[str, ...]
    calls: tuple[ir.Call, ...]
    expression: ir.Expr


class Memory:
    """Remembers values while functions are compared over the same inputs.

    most  bytes of values that are remembered; then all are forgotten
    """

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._held = 0
        self._pages = Pages()
        self._values: dict[Key, tuple[Value, list[Value]]] = {}
        self._inputs: dict[tuple[object, ...], tuple[Value, Any, int]] = {}
        self._prepared: dict[int, Prepared] = {}
        self._numbers: dict[tuple[ir.Expr, tuple[bool, ...]], int] = {}

    def inputs(
        self, function: ir.Function, given: Mapping[str, Any], arithmetic: Arithmetic
    ) -> tuple[dict[str, Value], int]:
        """The inputs as `convert_inputs` makes them; the same objects for the same given ones."""
        keys = {p.name: (p.name, p.type, id(given.get(p.name))) for p in function.parameters}
        if set(given) != set(keys) or any(key not in self._inputs for key in keys.values()):
            types = {p.name: p.type for p in function.parameters}
            arrays, count = convert_inputs(types, given, arithmetic, function.name, repeated=False)
            for name, value in arrays.items():
                self._inputs.setdefault(keys[name], (value, given[name], count))
        found = {name: self._inputs[key] for name, key in keys.items()}
        counts = {count for _, _, count in found.values()}
        assert len(counts) == 1, "a memory serves one number of lanes"
        return {name: value for name, (value, _, _) in found.items()}, counts.pop()

    def prepared(self, e: ir.Expr) -> Prepared:
        """The number that equal expressions share, with what it depends on; looked up once per object."""
        found = self._prepared.get(id(e))
        if found is None:
            number = self._numbers.setdefault((e, zeros(ir.walk(e))), len(self._numbers))
            found = self._prepared[id(e)] = Prepared(number, variables(e), tuple(outer_calls(e)), e)
        return found

    def find(self, key: Key) -> Value | None:
        """What is remembered under a key."""
        known = self._values.get(key)
        return None if known is None else known[0]

    def keep(self, key: Key, made: Value, of: list[Value]) -> Value:
        """Remember a value that was made of others; gives it as it is kept."""
        if self._held > self._most:
            self._values.clear()
            self._held = 0
        self._held += _bytes(made)
        if isinstance(made, np.ndarray):
            made = self._pages.moved(made)
        self._values[key] = made, of
        return made

    def value(self, what: str, of: list[Value], make: Callable[[], Value], lanes: int = 0) -> Value:
        """The value of a call, by its function's name, over those of its arguments, in so many lanes; or of
        anything else that a name and values tell."""
        key = (what, lanes, *map(id, of))
        found = self.find(key)
        return self.keep(key, make(), of) if found is None else found


def _bytes(value: Value) -> int:
    """What a value takes; a map is the caller's."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    return sum(map(_bytes, value.values())) if isinstance(value, dict) else 0


def outer_calls(e: ir.Expr) -> Iterator[ir.Call]:
    """The calls in an expression that are in no other call's arguments."""
    if isinstance(e, ir.Call):
        yield e
    else:
        for part in ir.children(e):
            yield from outer_calls(part)
