"""One function under one table: sampled share of the domain that is guaranteed, and the guaranteed error."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from codegen.intervals import permitted
from codegen.library import Library
from conformance.check import measure
from conformance.check.engine import Draw, draws, expected_of, find_reference
from conformance.check.features import applies
from conformance.reference import ambiguous

UNIFORM_COUNT = 4000
"""Random points per function: a guaranteed share is known to about 1 / 4000."""
FAMILY_COUNT = 250
"""Points from each family of hard cases."""


@dataclass
class Guarantee:
    """What a table guarantees of a function, on the inputs that were drawn.

    uniform  share of the random points of the domain whose result is bounded
    hard     the same of all hard cases
    errors   for each declared bound, the largest error that a permitted result has; None where the bound met
             no guaranteed input
    causes   cause -> share of all inputs that it leaves without a guarantee
    """

    uniform: float
    hard: float
    errors: list[float | None] = field(default_factory=list)
    causes: dict[str, float] = field(default_factory=dict)

    @property
    def everywhere(self) -> bool:
        return self.uniform == 1.0 and self.hard == 1.0


def sample(library: Library, name: str) -> list[tuple[Draw, Any, Any]]:
    """The inputs of a function with the reference's results (None: no reference) and doubtful lanes."""
    function = library.function(name)
    reference = find_reference(library, function)
    base = function.base if function.kind == "variant" else None
    return [
        (d, None if reference is None else expected_of(reference, d.inputs), ambiguous(name, d.inputs, base))
        for d in draws(function, UNIFORM_COUNT, FAMILY_COUNT)
    ]


def survey(library: Library, name: str, table: str, drawn: Iterable[tuple[Draw, Any, Any]]) -> Guarantee:
    """The guarantee of one table for one function on the drawn inputs."""
    targets = {"wgsl": "wgsl", "opencl": "opencl", "opencl_relaxed": "opencl"}
    bounds = library.bounds.get(name, ())
    errors: list[float | None] = [None] * len(bounds)
    causes: Counter[str] = Counter()
    counts: Counter[tuple[bool, bool]] = Counter()
    for d, truth, doubtful in drawn:
        found = permitted(library, name, d.inputs, table)
        sure = found.guaranteed
        counts[d.family == "uniform", True] += int(sure.sum())
        counts[d.family == "uniform", False] += int((~sure).sum())
        for cause, lanes in found.histogram().items():
            causes[cause.what] += lanes
        for k, bound in enumerate(bounds):
            if truth is None or (bound.targets and targets.get(table, "glsl") not in bound.targets):
                continue
            use = applies(bound, d.inputs, len(sure)) & sure & ~doubtful
            if use.any():
                ends = (found.low, found.high)
                worst = max(float(measure.error(bound, end, truth)[use].max()) for end in ends)
                errors[k] = max(errors[k] or 0.0, worst)
    total = sum(counts.values())
    return Guarantee(
        _share(counts[True, True], counts[True, False]),
        _share(counts[False, True], counts[False, False]),
        [None if e is None else _rounded_up(e) for e in errors],
        {what: float(f"{lanes / total:.2g}") for what, lanes in causes.most_common()},
    )


def _share(sure: int, unsure: int) -> float:
    """A share to four places, 1 only if nothing is missing."""
    return float(np.floor(1e4 * sure / max(sure + unsure, 1)) / 1e4)


def _rounded_up(x: float) -> float:
    """Two significant digits, not below x."""
    if x == 0.0 or not np.isfinite(x):
        return x
    step = 10.0 ** (np.floor(np.log10(x)) - 1)
    return float(f"{np.ceil(x / step - 1e-9) * step:.2g}")
