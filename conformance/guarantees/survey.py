"""One function under one table: sampled share of the domain that is guaranteed, and the guaranteed error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.guarantees import Guarantee
from codegen.intervals import permitted
from codegen.library import Library
from conformance.check import measure
from conformance.check.engine import draws, expected_of, find_reference
from conformance.check.features import applies
from conformance.guarantees.sample import Sample, together
from conformance.reference import ambiguous

UNIFORM_COUNT = 4000
"""Random points per function: a guaranteed share is known to about 1 / 4000."""
FAMILY_COUNT = 250
"""Points from each family of hard cases."""
TARGETS = {"wgsl": "wgsl", "opencl": "opencl", "opencl_relaxed": "opencl"}
"""The target whose bounds a table is held against; glsl for all others."""


@dataclass(frozen=True)
class Drawn:
    """Inputs of a function with the reference's results (None: no reference) and the doubtful lanes."""

    sample: Sample
    truth: Any
    doubtful: npt.NDArray[np.bool_]


def drawn_for(library: Library, name: str) -> Drawn:
    """The inputs on which a function is surveyed."""
    function = library.function(name)
    sample = together(draws(function, UNIFORM_COUNT, FAMILY_COUNT))
    reference = find_reference(library, function)
    base = function.base if function.kind == "variant" else None
    truth = None if reference is None else expected_of(reference, sample.inputs)
    return Drawn(sample, truth, ambiguous(name, sample.inputs, base))


def survey(library: Library, name: str, table: str, drawn: Drawn) -> Guarantee:
    """The guarantee of one table for one function on the drawn inputs."""
    found = permitted(library, name, drawn.sample.inputs, table)
    sure, uniform = found.guaranteed, drawn.sample.uniform
    target = TARGETS.get(table, "glsl")
    errors: list[float | None] = []
    for bound in library.bounds.get(name, ()):
        use = sure & ~drawn.doubtful & applies(bound, drawn.sample.inputs, len(sure))
        if drawn.truth is None or not use.any() or (bound.targets and target not in bound.targets):
            errors.append(None)
            continue
        ends = [measure.error(bound, end, drawn.truth) for end in (found.low, found.high)]
        errors.append(_rounded_up(max(float(e[use].max()) for e in ends)))
    causes: dict[str, float] = {}
    for cause, lanes in found.histogram().items():
        causes[cause.what] = causes.get(cause.what, 0.0) + lanes / len(sure)
    return Guarantee(
        _share(sure[uniform]),
        _share(sure[~uniform]),
        errors,
        {what: float(f"{share:.2g}") for what, share in causes.items()},
    )


def _share(sure: npt.NDArray[np.bool_]) -> float:
    """A share to four places, 1 only if nothing is missing."""
    return float(np.floor(1e4 * sure.sum() / max(len(sure), 1)) / 1e4)


def _rounded_up(x: float) -> float:
    """Two significant digits, not below x."""
    if x == 0.0 or not np.isfinite(x):
        return x
    step = 10.0 ** (np.floor(np.log10(x)) - 1)
    return float(f"{np.ceil(x / step - 1e-9) * step:.2g}")
