"""The proof: the specialised function is executed beside the general one before anything is written.

Where nothing was approximated, each result that differs in any bit must lie in the interval that the target's
specification permits for the general function; otherwise it must be within the budget of the general
function's value. Both are computed by the driver that is asked; the NumPy float32 evaluation stands in where
there is none.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.evaluate.arrays import Value
from codegen.intervals import DEFAULT_TABLES, permitted
from codegen.ir import nodes as ir
from codegen.library import Library
from codegen.scene.proof.errors import Floats, Measured, as_floats, distance
from codegen.scene.proof.points import Points

JUDGED = 16_384
"""Results that are judged by intervals, those farthest apart first; equal results need no judgement."""


Results = dict[tuple[str, tuple[ir.Stmt, ...]], Floats]
"""Results over one set of points by where they were computed and by the function's body."""


@dataclass(frozen=True)
class Proof:
    """What one driver, or the evaluation in its place, found.

    driver      the driver in words; "float32 evaluation" without one
    executed    whether a driver computed it
    points      inputs
    error       distance of the specialised function from the general one, on that driver or in float64,
                whichever is nearer
    general     distance of the general function on that driver from float64: what rounding alone does
    different   results that differ from the driver's own general function in any bit
    judged      results judged by intervals; 0 where a budget was
    outside     results outside their interval
    seconds     how long both took, building included
    """

    target: str
    driver: str
    executed: bool
    points: int
    error: Measured
    general: Measured
    different: int
    judged: int
    outside: int
    seconds: float
    first_outside: str = ""

    def holds(self, budget: float) -> bool:
        """Whether the specialised function may be written."""
        if budget == 0.0:
            return self.error.finite and self.outside == 0
        return self.error.within(budget)


def prove(
    library: Library,
    general: str,
    special: str,
    points: Points,
    exact: Floats,
    target: str,
    runtime: Any,
    budget: float,
    done: Results,
) -> Proof:
    """Execute both over the points.

    library  holds both functions
    exact    the general function's values in float64
    runtime  of the target; None: the float32 evaluation
    budget   largest absolute error; 0: by intervals
    done     results of earlier proofs over the same points, and those of this one
    """
    begin = time.perf_counter()
    before = _results(library, general, points, target, runtime, done)
    own = {p.name: points.inputs[p.name] for p in library.function(special).parameters}
    after = _results(library, special, points, target, runtime, done)
    seconds = time.perf_counter() - begin
    different = (before != after).any(axis=1)
    judged, outside, first = 0, 0, ""
    if budget == 0.0:
        judged, wrong = _judged(library, general, points, target, before, after, different)
        outside = len(wrong)
        first = _point(own, int(wrong[0])) if outside else ""
    return Proof(
        target=target,
        driver=_driver(runtime),
        executed=runtime is not None,
        points=points.count,
        error=distance(after, exact, before),
        general=distance(before, exact),
        different=int(different.sum()),
        judged=judged,
        outside=outside,
        seconds=seconds,
        first_outside=first,
    )


def _results(library: Library, name: str, points: Points, target: str, runtime: Any, done: Results) -> Floats:
    f = library.function(name)
    key = "float32" if runtime is None else target, f.body
    if key not in done:
        inputs = {p.name: points.inputs[p.name] for p in f.parameters}
        if runtime is None:
            done[key] = as_floats(evaluate(library, name, inputs, "float32"))
        else:
            from codegen.execute import execute  # not without a driver

            done[key] = as_floats(execute(library, name, inputs, runtime))
    return done[key]


def _judged(
    library: Library,
    general: str,
    points: Points,
    target: str,
    before: Floats,
    after: Floats,
    different: npt.NDArray[np.bool_],
) -> tuple[int, npt.NDArray[np.intp]]:
    """How many results were held against their interval, and the lanes outside."""
    apart = np.abs(before - after).max(axis=1)
    order = np.argsort(-np.where(different, apart, -1.0), kind="stable")
    lanes = order[: min(int(different.sum()), JUDGED)]
    if not len(lanes):
        return 0, lanes
    some = {name: np.asarray(v)[lanes] for name, v in points.inputs.items()}
    allowed = permitted(library, general, some, DEFAULT_TABLES[target])
    return len(lanes), lanes[~allowed.contains(after[lanes])]


def _point(inputs: Mapping[str, Value], lane: int) -> str:
    """One point's inputs, for a sentence."""
    return ", ".join(f"{name} = {np.asarray(v)[lane].tolist()}" for name, v in inputs.items())


def _driver(runtime: Any) -> str:
    if runtime is None:
        return "float32 evaluation"
    device = runtime.device
    return f"{device.device}; {device.driver}; {device.api}"
