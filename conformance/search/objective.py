"""What the search maximises: the error of a function on a driver, in units of each declared bound."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.library import Library
from conformance.check import measure
from conformance.check.engine import Backend, expected_of, find_reference
from conformance.check.features import applies
from conformance.reference import ambiguous

OUTSIDE = -1.0
"""Score of an input outside a bound's domain, below any error."""


class Objective:
    """The error of one function on one backend under each of its bounds."""

    def __init__(self, library: Library, name: str, on: Backend) -> None:
        """Raises KeyError for a function without bounds or without a reference."""
        self.library = library
        self.function = library.function(name)
        self.on = on
        self.bounds = [b for b in library.bounds.get(name, ()) if not b.targets or on.target in b.targets]
        self.base = self.function.base if self.function.kind == "variant" else None
        reference = find_reference(library, self.function)
        if reference is None or not self.bounds:
            raise KeyError(f"{name} has no reference or no bound on {on.target}")
        self.reference = reference

    def errors(self, inputs: Mapping[str, Any], count: int) -> npt.NDArray[np.float64]:
        """Errors (bounds, n) in each bound's measure; OUTSIDE where the bound does not apply, inf where the
        result is not finite."""
        name = self.function.name
        got = self.on.run(self.library, name, inputs)
        with np.errstate(all="ignore"):
            expected = expected_of(self.reference, inputs)
            finite = measure.finite(got)
            doubtful = ambiguous(name, inputs, self.base)
            rows = []
            for bound in self.bounds:
                inside = applies(bound, inputs, count) & ~doubtful
                error = measure.error(bound, got, expected)
                rows.append(np.where(finite, np.where(inside, error, OUTSIDE), np.inf))
        return np.stack(rows)

    def scores(self, errors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Errors in units of their bounds; an exact bound is either kept (0) or missed (inf)."""
        units = np.array([b.bound if b.measure != "exact" else 1.0 for b in self.bounds])[:, None]
        return np.where(errors < 0.0, OUTSIDE, errors / np.where(units > 0.0, units, 1.0))
