"""Pairs: two calls whose results must agree, made of relations, functions and random programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any
from zlib import crc32

import numpy as np

from codegen.evaluate.arrays import Value
from codegen.ir.nodes import Function, Parameter
from codegen.library import Library
from conformance import cases
from conformance.fuzz.choices import Choice
from conformance.fuzz.reduce import settled
from conformance.metamorphic.relation import (
    Changed,
    Ends,
    InputRelation,
    SourceRelation,
    map_arrays,
    unchanged,
)
from conformance.metamorphic.source.calls import inlined
from conformance.programs.batch import Job


@dataclass(frozen=True)
class Pair:
    """Two calls. `result` says what the first one's result becomes in the second."""

    relation: str
    subject: str
    first: Job
    second: Job
    result: Callable[[Function, Ends], Ends]
    is_exact: bool
    tolerance: float
    added: tuple[Function, ...] = ()


SAME_MEANING = 1e-9
"""How far two programs of one meaning may differ in float64, relative to 1 + |value|: its own rounding."""


def seed_of(*parts: str) -> int:
    """A seed that depends on names alone."""
    return crc32("/".join(parts).encode())


def source_pair(
    relation: SourceRelation,
    function: Function,
    library: Library,
    draw_inputs: Callable[[], dict[str, Any]],
    lanes: int,
) -> Pair | None:
    """A function and its rewriting; its calls are written out first, where it offers nothing itself."""
    choice = Choice(seed_of(relation.name, function.name))
    changed = relation.apply(function, library, choice) or relation.apply(
        inlined(function, library), library, choice
    )
    if changed is None:
        return None
    inputs = draw_inputs()
    rewritten = settled(replace(changed.function, name=f"{function.name}_{relation.name}"))
    return Pair(
        relation.name,
        function.name,
        Job(function.name, inputs),
        Job(rewritten.name, {**inputs, **constants(changed, lanes)}),
        unchanged,
        True,
        SAME_MEANING,
        (*(_named_apart(c, relation) for c in changed.callees), _calling_apart(rewritten, changed, relation)),
    )


def constants(changed: Changed, lanes: int) -> dict[str, Any]:
    """The added parameters' values, one for all lanes."""
    return {name: np.full(lanes, value, np.float32) for name, value in changed.added.items()}


def _named_apart(callee: Function, relation: SourceRelation) -> Function:
    return replace(callee, name=f"{callee.name}_{relation.name}")


def _calling_apart(function: Function, changed: Changed, relation: SourceRelation) -> Function:
    """The function, calling its new callees by the names that no other rewriting uses."""
    from codegen.ir import nodes as ir

    names = {c.name: _named_apart(c, relation).name for c in changed.callees}

    def call(e: ir.Expr) -> ir.Expr:
        return replace(e, function=names[e.function]) if isinstance(e, ir.Call) and e.function in names else e

    return replace(function, body=ir.map_body(function.body, call))


def input_pair(relation: InputRelation, function: Function, inputs: dict[str, Any]) -> Pair:
    """A function on two inputs. Lanes of which the relation says nothing repeat the first other one."""
    silent = relation.silent(inputs) if relation.silent else np.zeros(1, np.bool_)
    if silent.any():
        first, lanes = int(np.argmin(silent)), np.arange(len(silent))
        chosen = np.where(silent, first, lanes)
        inputs = {name: map_arrays(value, lambda a: a[chosen]) for name, value in inputs.items()}
    choice = Choice(seed_of(relation.name, function.name))
    return Pair(
        relation.name,
        function.name,
        Job(function.name, inputs),
        Job(function.name, relation.inputs(function, inputs, choice)),
        relation.result,
        relation.is_exact,
        relation.tolerance,
    )


def draw(function: Function, lanes: int, seed: int) -> dict[str, Any]:
    """Inputs inside a function's domain: half uniform, half from its families of hard cases in turn."""
    families = _families(function.name, function.parameters)
    family = families[seed % len(families)]
    first, second = (cases.draw(function, name, lanes // 2, seed) for name in ("uniform", family))
    return {name: _joined(first[name], second[name]) for name in first}


@cache
def _families(name: str, parameters: tuple[Parameter, ...]) -> tuple[str, ...]:
    return tuple(cases.families_for(parameters))


def _joined(a: Any, b: Any) -> Any:
    if isinstance(a, dict):
        return {name: _joined(a[name], b[name]) for name in a}
    return np.concatenate([a, b])


def columns(value: Value) -> Iterator[Any]:
    """Every array of a value."""
    if isinstance(value, dict):
        for part in value.values():
            yield from columns(part)
    else:
        yield value
