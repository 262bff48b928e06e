"""Makes a failing program small: greedy changes that keep the same kind of failure on the same backend."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.frontend.statements import mark_mutable
from codegen.ir import nodes as ir
from codegen.ir.verify import MalformedIRError, verify_selection
from codegen.library import Library
from conformance.fuzz.shrink import size, smaller
from conformance.programs import batch, judge, rearranged
from targets import BuildFailed, Runtime

MOST_TRIES = 4_000
"""Candidates after which a reduction stops with what it has."""

Fails = Callable[[Library, str], bool]
"""Whether a function of a library still shows the failure."""


@dataclass(frozen=True)
class Reduced:
    """A reduced program: the library that holds it, its entry, its size in IR nodes, the candidates tried."""

    library: Library
    entry: str
    nodes: int
    tries: int

    @property
    def functions(self) -> tuple[ir.Function, ...]:
        return self.library.select([self.entry]).functions


def reduce(library: Library, entry: str, fails: Fails) -> Reduced:
    """The smallest program found that still fails. Changes to the entry and to what it calls are tried."""
    current = library
    tries = 0
    progress = True
    while progress and tries < MOST_TRIES:
        progress = False
        for function in reversed(current.select([entry]).functions):
            for candidate in smaller(current.function(function.name)):
                if function.name != entry and candidate.returns != function.returns:
                    continue  # the callers want the type
                tries += 1
                if tries >= MOST_TRIES:
                    break
                proposed = current.with_functions([settled(candidate)])
                if _better(proposed, current, entry) and fails(proposed, entry):
                    current, progress = proposed, True
                    break
            if progress:
                break
    return Reduced(current, entry, size(current.select([entry]).functions), tries)


def _better(proposed: Library, current: Library, entry: str) -> bool:
    """Well formed, and smaller."""
    try:
        functions = proposed.select([entry]).functions
        verify_selection(functions)
    except (MalformedIRError, UserError):
        return False
    before = current.select([entry]).functions
    return (size(functions), _statements(functions)) < (size(before), _statements(before))


def _statements(functions: tuple[ir.Function, ...]) -> int:
    return sum(sum(1 for _ in ir.statements(f.body)) for f in functions)


def settled(function: ir.Function) -> ir.Function:
    """The function with its locals marked mutable as the front end does."""
    return replace(function, body=mark_mutable(function.body))


def wrong_value(inputs: Mapping[str, Any], lane: int, runtime: Runtime | None) -> Fails:
    """The failure 'outside its interval' in one lane; without a runtime, of the evaluator."""
    one = {name: _lane(value, lane) for name, value in inputs.items()}

    def fails(library: Library, entry: str) -> bool:
        target = runtime.device.target if runtime is not None else ""
        try:
            if runtime is None:
                value = evaluate(library, entry, one)
            else:
                value = batch.run(library, [batch.Job(entry, one)], runtime, 1)[0]
        except BuildFailed:
            return False
        wrong = judge.judge(judge.intervals(library, entry, one, target), value).wrong
        return bool(wrong.any()) and not rearranged.explained(library, entry, one, target, value).all()

    return fails


def refused_text(runtime: Runtime) -> Fails:
    """The failure 'the driver's compiler refuses the text'."""

    def fails(library: Library, entry: str) -> bool:
        try:
            runtime.run(
                batch.program(library, [entry], runtime.device.target), np.zeros((64, 1), np.uint32), 64
            )
        except BuildFailed:
            return True
        return False

    return fails


def _lane(value: Any, lane: int) -> Any:
    if isinstance(value, dict):
        return {name: _lane(v, lane) for name, v in value.items()}
    return np.asarray(value)[lane : lane + 1]
